"""Writes the small images beside it and references.txt: what nibabel and SimpleITK, programs of others, read of them.

The label of voxel (i, j, k) is (i + 3 j + 7 k) mod 11. A line of references.txt is: file, sizes, then the twelve numbers of the matrix from
(i, j, k, 1) to RAS in mm, row by row, as the reader named at the line's end gives them. Run it anew only to add a file:

    python -m venv v && v/bin/pip install nibabel SimpleITK && v/bin/python tests/image/data/write_references.py
"""

import gzip
import pathlib

import nibabel
import numpy
import SimpleITK

HERE = pathlib.Path(__file__).parent
SIZE = (5, 4, 3)
I, J, K = numpy.meshgrid(*(numpy.arange(n) for n in SIZE), indexing="ij")
LABELS = (I + 3 * J + 7 * K) % 11
LINES = []


def turn(axis, degrees):
    """Rodrigues' matrix of a turn."""
    a = numpy.radians(degrees)
    x, y, z = axis / numpy.linalg.norm(axis)
    skew = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(a) * skew + (1 - numpy.cos(a)) * skew @ skew


def note(name, affine, reader):
    numbers = " ".join(repr(float(x)) for x in numpy.asarray(affine)[:3].ravel())
    LINES.append(f"{name} {SIZE[0]} {SIZE[1]} {SIZE[2]} {numbers} {reader}")


def by_nibabel(name):
    note(name, nibabel.load(HERE / name).affine, "nibabel")


def by_itk(name):
    image = SimpleITK.ReadImage(str(HERE / name))
    assert image.GetSize() == SIZE
    assert (SimpleITK.GetArrayFromImage(image).transpose() == LABELS).all(), name
    columns = numpy.array(image.GetDirection()).reshape(3, 3) * numpy.array(image.GetSpacing())
    lps = numpy.column_stack([columns, image.GetOrigin()])
    note(name, numpy.diag([-1, -1, 1]) @ lps, "SimpleITK")


def nifti(name, matrix, offset, kind=numpy.uint8, version=nibabel.Nifti1Image, sform=1, qform=0, big=False, units="mm"):
    affine = numpy.eye(4)
    affine[:3, :3], affine[:3, 3] = matrix, offset
    header = version.header_class(endianness=">" if big else "<")
    header.set_data_dtype(numpy.dtype(kind).newbyteorder(">" if big else "<"))
    image = version(LABELS.astype(kind), None, header)
    image.header.set_xyzt_units(units)
    image.set_sform(affine if sform else None, sform)
    image.set_qform(affine if qform else None, qform)
    image.to_filename(HERE / name)
    by_nibabel(name)


SPACING = numpy.diag([0.7, 1.25, 3.1])
TURNED = turn(numpy.array([1.0, 2.0, -0.5]), 37.0)
OFFSET = numpy.array([-177.956, 11.319, 94.302])
SHEAR = numpy.array([[1.0, 0.2, 0.0], [0.0, 1.0, -0.3], [0.0, 0.0, 1.0]])

nifti("sform.nii", TURNED @ SPACING, OFFSET)
nifti("sform_sheared.nii.gz", TURNED @ SHEAR @ SPACING, OFFSET, numpy.int16)
nifti("sform_flipped.nii.gz", numpy.diag([-1, 1, -1]) @ SPACING, OFFSET, numpy.float32)
nifti("qform.nii.gz", TURNED @ SPACING, OFFSET, numpy.uint16, sform=0, qform=1)
nifti("qform_half_turn.nii", numpy.diag([-1, -1, 1]) @ SPACING, OFFSET, sform=0, qform=1)
nifti("qform_left_handed.nii", TURNED @ numpy.diag([1, 1, -1]) @ SPACING, OFFSET, sform=0, qform=1)
nifti("big_endian.nii", TURNED @ SPACING, OFFSET, numpy.int32, big=True)
nifti("second_version.nii.gz", TURNED @ SPACING, OFFSET, numpy.float64, nibabel.Nifti2Image)
nifti("second_version_big.nii", TURNED @ SPACING, OFFSET, numpy.int64, nibabel.Nifti2Image, sform=0, qform=1, big=True)

image = SimpleITK.GetImageFromArray(LABELS.transpose().astype(numpy.uint8))
image.SetSpacing((0.7, 1.25, 3.1))
image.SetDirection(TURNED.ravel())
image.SetOrigin(OFFSET)
for name, packed in (("turned.nrrd", True), ("turned_raw.nrrd", False), ("turned.mha", True), ("turned_raw.mha", False), ("turned.mhd", False)):
    SimpleITK.WriteImage(image, str(HERE / name), packed)
    by_itk(name)
wide = SimpleITK.Cast(image, SimpleITK.sitkInt16)
wide.SetDirection((numpy.diag([-1, 1, -1]) @ TURNED).ravel())
SimpleITK.WriteImage(wide, str(HERE / "left_handed.mha"), True)
by_itk("left_handed.mha")

# By hand: a space of RAS, sheared directions, big-endian numbers and the segments of 3D Slicer.
columns = (TURNED @ SHEAR @ SPACING).transpose()
vectors = " ".join("(" + ",".join(repr(float(x)) for x in c) + ")" for c in columns)
text = f"""NRRD0005
# by hand
type: short
dimension: 3
space: right-anterior-superior
sizes: 5 4 3
space directions: {vectors}
kinds: domain domain domain
endian: big
encoding: gzip
space origin: (-177.956,11.319,94.302)
Segment0_ID:=Segment_1
Segment0_LabelValue:=5
Segment0_Name:=liver
Segment1_ID:=Segment_2
Segment1_LabelValue:=7
Segment1_Name:=portal vein

"""
data = gzip.compress(LABELS.transpose().astype(">i2").tobytes(), mtime=0)
(HERE / "segments.seg.nrrd").write_bytes(text.encode() + data)
by_itk("segments.seg.nrrd")
detached = text.replace("endian: big", "endian: little").replace("encoding: gzip", "encoding: raw\ndata file: detached.raw\nbyte skip: -1")
(HERE / "detached.nhdr").write_bytes(detached.strip().encode() + b"\n")
(HERE / "detached.raw").write_bytes(b"some bytes before" + LABELS.transpose().astype("<i2").tobytes())
by_itk("detached.nhdr")

(HERE / "references.txt").write_text("\n".join(LINES) + "\n", encoding="utf-8")
