"""Images of labels as arrays: their meshes, cleaning, files, and fields of bodies on voxels."""

import pickle

import glisson
import numpy as np
import pytest

AFFINE = np.array([[-3.0, 0.0, 0.0, 60.0], [0.0, 2.8, 0.4, -30.0], [0.0, -0.4, 2.8, 10.0], [0.0, 0.0, 0.0, 1.0]])


def organ(size=(26, 24, 22)):
    """A ball of label 5 with one of 64 in it, and an island."""
    i, j, k = np.indices(size)
    distance = np.sqrt((i - 12.5) ** 2 + (j - 11.5) ** 2 + (k - 10.5) ** 2)
    labels = np.where(distance > 9, 0, np.where(distance < 4.5, 64, 5)).astype(np.uint8)
    labels[1, 1, 1] = 5
    return labels


def test_an_array_meshes_as_its_file_does(tmp_path):
    labels = glisson.LabelImage(organ(), AFFINE, {5: "organ"})
    glisson.image.write(tmp_path / "a.nii.gz", labels)
    back = glisson.image.read(tmp_path / "a.nii.gz")
    assert isinstance(back, glisson.LabelImage) and back.names == {5: "organ"}
    np.testing.assert_array_equal(back.voxels, organ())
    np.testing.assert_allclose(back.affine, AFFINE, atol=1e-5)
    chosen = {"regions": ["organ", "64"], "implants": ["clip=ball:22,0,40,9mm"]}
    made = glisson.image.mesh(organ(), back.affine, names={5: "organ"}, **chosen)
    assert made.mesh == glisson.image.mesh(tmp_path / "a.nii.gz", **chosen).mesh
    assert made.mesh.region_names == {5: "organ", 64: "label_64", 65: "clip"}
    assert [r.name for r in made.regions] == ["clip", "organ", "label_64"]
    for region in made.regions:
        assert region.volume == pytest.approx(region.image_volume, rel=0.05)
        assert region.pieces == region.image_pieces == 1
        assert 0 < region.distance_p95 < 0.0015
    assert any("islands" in note or "piece" in note for note in made.notes)


def test_labels_are_cleaned_and_listed():
    cleaned, report = glisson.image.clean(organ(), AFFINE, ["organ=5+64"])
    assert set(np.unique(cleaned.voxels)) == {0, 5} and cleaned.voxels[1, 1, 1] == 0
    assert cleaned.names == {5: "organ"} and any("mL" in line for line in report)
    kept, _ = glisson.image.clean(organ(), AFFINE, ["5"], smallest_piece_ml=0.0)
    first, _second = glisson.image.figures(organ(), AFFINE, names={5: "organ"})
    assert (first.label, first.name, first.pieces) == (5, "organ", 2)
    assert first.volume == pytest.approx((organ() == 5).sum() * abs(np.linalg.det(AFFINE[:3, :3])) * 1e-9)
    assert np.count_nonzero(kept.voxels) >= np.count_nonzero(organ() == 5)


def test_a_linear_field_is_exact_on_the_voxels(tmp_path):
    mesh = glisson.box_mesh(cells=[4, 4, 6], size=[0.04, 0.04, 0.06], origin=[-0.02, -0.02, 0.01])
    affine = AFFINE.copy()
    affine[:3, 3] = [20.53, -21.37, 11.21]
    slope, size = np.array([[100.0, -30.0, 70.0], [1.0, 2.0, 3.0]]), (14, 15, 16)
    places = glisson.image.places(mesh, (size, affine))
    values = places.vertex_values(mesh.vertices @ slope.T + 5.0)
    world = 1e-3 * (np.moveaxis(np.indices(size), 0, -1) @ affine[:3, :3].T + affine[:3, 3])
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    inside = np.all((world > low) & (world < high), axis=-1)
    assert values.shape == (*size, 2) and inside.sum() == places.inside > 100
    np.testing.assert_array_equal(np.isnan(values[..., 0]), ~inside)
    np.testing.assert_allclose(values[inside], world[inside] @ slope.T + 5.0, rtol=1e-6)
    own = places.tet_values(np.full(len(mesh.tets), 7.0), "own", outside=-1.0)
    np.testing.assert_array_equal(own, np.where(inside, 7.0, -1.0))
    glisson.image.write(tmp_path / "v.nii", values[..., 0], affine)
    grey = glisson.image.read(tmp_path / "v.nii")
    assert isinstance(grey, glisson.GreyImage)
    np.testing.assert_array_equal(grey.voxels, values[..., 0])
    assert set(np.unique(glisson.image.places(mesh, grey).labels(outside=9).voxels)) == {0, 9}


def test_what_cannot_be_is_refused_as_the_program_says():
    with pytest.raises(ValueError, match=r"voxel \(2, 1, 0\) is 0.5, which is no label"):
        labels = np.zeros((4, 4, 4))
        labels[2, 1, 0] = 0.5
        glisson.LabelImage(labels, AFFINE)
    with pytest.raises(ValueError, match="no voxel has the label 7; there are: 5, 64"):
        glisson.image.mesh(organ(), AFFINE, ["7"])
    with pytest.raises(ValueError, match="needs its affine"):
        glisson.image.mesh(organ())
    with pytest.raises(ValueError, match="span no volume"):
        glisson.LabelImage(organ(), np.zeros((4, 4)))
    with pytest.raises(ValueError, match="4 dimensions"):
        glisson.LabelImage(np.zeros((3, 3, 3, 2), dtype=int), AFFINE)
    with pytest.raises(TypeError, match="did you mean 'smoothing'"):
        glisson.image.mesh(organ(), AFFINE, ["5"], smothing=3)
    with pytest.raises(ValueError, match="a vector has 3 components, not 2"):
        glisson.image.write("u.nii", np.zeros((2, 2, 2, 2)), AFFINE, kind="vector")


def test_images_pickle():
    image = pickle.loads(pickle.dumps(glisson.LabelImage(organ(), AFFINE, {5: "organ"})))
    np.testing.assert_array_equal(image.voxels, organ())
    assert image.names == {5: "organ"}


def test_other_readers_see_the_same_grid_and_numbers(tmp_path):
    nibabel, sitk = pytest.importorskip("nibabel"), pytest.importorskip("SimpleITK")
    straight = np.array([[0.0, -2.0, 0.0, 31.0], [3.0, 0.0, 0.0, -12.0], [0.0, 0.0, 2.5, 7.0], [0, 0, 0, 1.0]])
    field = np.random.default_rng(1).normal(size=(5, 6, 7, 3)).astype(np.float32)
    glisson.image.write(tmp_path / "u.nii.gz", field, straight, kind="displacement")
    by_nibabel = nibabel.load(tmp_path / "u.nii.gz")
    np.testing.assert_array_equal(by_nibabel.affine, straight)
    np.testing.assert_allclose(by_nibabel.get_qform(), straight, atol=1e-5)
    np.testing.assert_array_equal(np.asarray(by_nibabel.dataobj)[:, :, :, 0], field)
    by_itk = sitk.ReadImage(str(tmp_path / "u.nii.gz"))  # which turns displacements into LPS
    np.testing.assert_array_equal(sitk.GetArrayFromImage(by_itk), np.moveaxis(field, (0, 1, 2), (2, 1, 0)) * [-1, -1, 1])
    glisson.image.write(tmp_path / "l.nii.gz", glisson.LabelImage(organ(), straight))
    array, affine = glisson.image.from_sitk(sitk.ReadImage(str(tmp_path / "l.nii.gz")))
    np.testing.assert_array_equal(array, organ())
    np.testing.assert_allclose(affine, straight, atol=1e-5)
