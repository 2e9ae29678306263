"""Labelled images: arrays with an affine become bodies, and fields of bodies become images.

Arrays are (i, j, k). An affine is (4, 4), from a voxel (i, j, k, 1) to its centre in RAS and millimetres, as nibabel has it, so that what
nibabel, SimpleITK or pydicom open needs no file in between:

    image = nibabel.load("labels.nii.gz")
    made = glisson.image.mesh(image.dataobj, image.affine, regions=["liver=5", "veins=63+64"], edge=0.006)
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import GreyImage, ImageMesh, LabelFigures, LabelImage, TetMesh, VoxelPlaces

__all__ = ["clean", "figures", "from_sitk", "mesh", "places", "read", "write"]

_VOXELS_AN_EDGE = 2.0
Labels = LabelImage | str | os.PathLike[str] | npt.ArrayLike


def read(file: str | os.PathLike[str]) -> LabelImage | GreyImage:
    """An image of a file: NIfTI, NRRD or MetaImage; one of labels where all its numbers are whole and from 0 to 65535.

    :return: its `voxels` (i, j, k), `affine`, `names` of labels, and `notes` on what the file leaves open
    :raises ValueError: where the file cannot be used, as the program says
    """
    try:
        return _core.read_label_image(Path(file))
    except ValueError as error:
        if "no label; allowed" not in str(error):
            raise
        return _core.read_grey_image(Path(file))


def from_sitk(image: Any) -> tuple[npt.NDArray[Any], npt.NDArray[np.float64]]:
    """Array (i, j, k) and affine of an image of SimpleITK, whose axes are LPS.

    :raises ValueError: for an image of other than three dimensions
    """
    if image.GetDimension() != 3:
        raise ValueError(f"the image has {image.GetDimension()} dimensions; a body needs three")
    array = importlib.import_module("SimpleITK").GetArrayFromImage(image)  # a copy: views end with the image
    affine = np.eye(4)
    affine[:3, :3] = np.reshape(image.GetDirection(), (3, 3)) * np.asarray(image.GetSpacing())
    affine[:3, 3] = image.GetOrigin()
    affine[:2] *= -1.0
    return np.moveaxis(array, (0, 1, 2), (2, 1, 0)), affine


def figures(labels: Labels, affine: npt.ArrayLike | None = None, *, names: Mapping[int, str] | None = None) -> list[LabelFigures]:
    """Name, volume [m³], pieces and extent of each label, as `glisson info` lists them.

    :param labels: an image, a file, or an array with its affine
    """
    return _core.label_figures(_labels(labels, affine, names))


def clean(
    labels: Labels,
    affine: npt.ArrayLike | None = None,
    regions: Sequence[str] = (),
    *,
    names: Mapping[int, str] | None = None,
    **options: Any,
) -> tuple[LabelImage, list[str]]:
    """Labels that are chosen, joined and cleaned, and a line for each step, in mL.

    :param regions: as those of `mesh`
    :param options: fields of `CleanLabels`: voxel [m], keep_pieces, smallest_piece_ml, largest_hole_ml
    :raises ValueError: as the program says
    """
    return _core.clean_labels(_labels(labels, affine, names), list(regions), _core.CleanLabels(**options))


def mesh(
    labels: Labels,
    affine: npt.ArrayLike | None = None,
    regions: Sequence[str] = (),
    *,
    names: Mapping[int, str] | None = None,
    edge: float | None = None,
    **options: Any,
) -> ImageMesh:
    """The mesh of labels, in metres and RAS: that of `glisson mesh IMAGE`.

    :param labels: an image, a file, or an array (i, j, k) of whole numbers with its affine
    :param regions: numbers or names of labels, joined by +, with a name in front: "veins=63+64"
    :param names: of labels, of an array
    :param edge: mean length of edges [m]; none: two voxels
    :param options: fields of `ImageBody`, as implants=["tumour=ball:80,165,400,18mm"], beside, smoothing, sizes
    :return: its `mesh`, `regions` beside their voxels, `report` and `notes`
    :raises ValueError: as the program says
    """
    image = labels if isinstance(labels, LabelImage) else _labels(labels, affine, names)
    if edge is None:
        voxel = options.get("voxel") or 1e-3 * abs(np.linalg.det(np.asarray(image.affine)[:3, :3])) ** (1 / 3)
        edge = _VOXELS_AN_EDGE * float(voxel)
    return _core.image_mesh(_core.ImageBody(image=image, labels=list(regions), edge=edge, **options))


def places(
    body: TetMesh,
    like: LabelImage | GreyImage | str | os.PathLike[str] | tuple[Sequence[int], npt.ArrayLike],
    positions: npt.ArrayLike | None = None,
) -> VoxelPlaces:
    """Where the voxels of an image are in a mesh: its `vertex_values`, `tet_values` and `labels` are arrays on them.

    :param like: an image, a file, or shape and affine
    :param positions: (n, 3) of the vertices [m], as those of a deformed body; none: at rest
    """
    shape, affine = like if isinstance(like, tuple) else _grid(like)
    i, j, k = (int(n) for n in shape)
    return VoxelPlaces(body, [i, j, k], affine, positions)


def write(
    file: str | os.PathLike[str],
    values: LabelImage | npt.ArrayLike,
    affine: npt.ArrayLike | None = None,
    *,
    kind: Literal["plain", "vector", "displacement", "symmetric"] = "plain",
    description: str = "",
) -> None:
    """Writes NIfTI (.nii, .nii.gz): labels with their names, or values (i, j, k) or (i, j, k, c) in single precision.

    :param kind: of several components along RAS; "displacement" is in mm
    :raises ValueError: as the program says
    """
    if isinstance(values, LabelImage):
        _core.write_label_image(Path(file), values, description)
        return
    if affine is None:
        raise ValueError("an array needs its affine: (4, 4), from a voxel (i, j, k, 1) to RAS in mm")
    _core.write_values(Path(file), values, affine, kind, description)


def _grid(like: LabelImage | GreyImage | str | os.PathLike[str]) -> tuple[Sequence[int], npt.ArrayLike]:
    image = like if isinstance(like, LabelImage | GreyImage) else read(like)
    return image.voxels.shape, image.affine


def _labels(labels: Labels, affine: npt.ArrayLike | None, names: Mapping[int, str] | None) -> LabelImage:
    """An image of labels from whatever stands for one."""
    if isinstance(labels, LabelImage):
        return labels
    if isinstance(labels, str | os.PathLike):
        return _core.read_label_image(Path(labels))
    if affine is None:
        raise ValueError("an array needs its affine: (4, 4), from a voxel (i, j, k, 1) to RAS in mm")
    return LabelImage(labels, affine, dict(names or {}))
