"""Triangles into a picture with NumPy: a depth buffer, no display, no graphics card.

Each triangle's box of pixels is looked at, triangles of boxes of one size at a time; of all that cover a pixel the nearest stays.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

_AT_ONCE = 2_000_000  # candidates of pixels that are looked at together
_LARGEST = 96.0  # pixels that a triangle may be wide; larger ones are split


@dataclass
class Buffers:
    """What is seen in each pixel."""

    depth: Any  # (h, w), ∞ where nothing is
    triangle: Any  # (h, w), −1 where nothing is
    weights: Any  # (h, w, 3) of the triangle's corners


def rasterise(corners: Any, width: int, height: int) -> Buffers:
    """:param corners: (n, 3, 3): of each triangle x to the right, y down in pixels, and depth away from the eye"""
    buffers = Buffers(
        np.full(height * width, np.inf), np.full(height * width, -1, dtype=np.int64), np.zeros((height * width, 3))
    )
    corners, origin, shares = _split(np.asarray(corners, dtype=float))
    low = np.floor(np.clip(corners[:, :, :2].min(axis=1), 0, [width, height])).astype(int)
    high = np.ceil(np.clip(corners[:, :, :2].max(axis=1), 0, [width, height])).astype(int)
    size = high - low
    seen = (size > 0).all(axis=1)
    classes = np.ceil(np.log2(np.maximum(size, 1))).astype(int)
    for key in np.unique(classes[seen], axis=0):
        group = np.flatnonzero(seen & (classes == key).all(axis=1))
        box = 2**key
        step = max(1, _AT_ONCE // int(box.prod()))
        for at in range(0, len(group), step):
            _draw(buffers, corners, low, group[at : at + step], box, origin, shares, width, height)
    return Buffers(
        buffers.depth.reshape(height, width),
        buffers.triangle.reshape(height, width),
        buffers.weights.reshape(height, width, 3),
    )


def _split(corners: Any) -> tuple[Any, Any, Any]:
    """Triangles in four, until none is too large: pieces, which triangle each is of, and its corners in that one's weights."""
    origin = np.arange(len(corners))
    shares = np.broadcast_to(np.eye(3), (len(corners), 3, 3)).copy()
    for _ in range(8):
        large = (np.ptp(corners[:, :, :2], axis=1) > _LARGEST).any(axis=1)
        if not large.any():
            break
        pieces = []
        for values in (corners[large], shares[large]):
            a, b, c = values[:, 0], values[:, 1], values[:, 2]
            ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
            pieces.append(np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]))
        corners = np.concatenate([corners[~large], pieces[0]])
        shares = np.concatenate([shares[~large], pieces[1]])
        origin = np.concatenate([origin[~large], np.tile(origin[large], 4)])
    return corners, origin, shares


def _draw(
    buffers: Buffers, corners: Any, low: Any, group: Any, box: Any, origin: Any, shares: Any, width: int, height: int
) -> None:
    columns, rows = np.meshgrid(np.arange(box[0]), np.arange(box[1]))
    x = low[group, 0][:, None] + columns.ravel()
    y = low[group, 1][:, None] + rows.ravel()
    a, b, c = (corners[group, k, :2] for k in range(3))
    twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        px, py = x + 0.5, y + 0.5

        def weight(p: Any, q: Any) -> Any:
            return (
                (q[:, 0] - p[:, 0])[:, None] * (py - p[:, 1][:, None]) - (q[:, 1] - p[:, 1])[:, None] * (px - p[:, 0][:, None])
            ) / twice[:, None]

        wa, wb = weight(b, c), weight(c, a)
        wc = 1.0 - wa - wb
        inside = (wa >= -1e-9) & (wb >= -1e-9) & (wc >= -1e-9) & (x < width) & (y < height)
    which, place = np.nonzero(inside)
    local = np.stack([wa[which, place], wb[which, place], wc[which, place]], axis=1)
    depth = np.einsum("ik,ik->i", local, corners[group[which], :, 2])
    pixel = y[which, place] * width + x[which, place]
    nearer = depth < buffers.depth[pixel]
    which, local, depth, pixel = which[nearer], local[nearer], depth[nearer], pixel[nearer]
    order = np.argsort(-depth, kind="stable")  # of a pixel's candidates the nearest is written last, and stays
    pixel, triangle = pixel[order], group[which[order]]
    buffers.depth[pixel] = depth[order]
    buffers.triangle[pixel] = origin[triangle]
    buffers.weights[pixel] = np.einsum("ik,ikj->ij", local[order], shares[triangle])
