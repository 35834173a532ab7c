"""Frames of whole numbers as text that is short and loses nothing.

A channel is one number per particle, q [frames, n]: a coordinate in 16 bits, a velocity component
or a scalar in 8.  What is kept is how far it is from what was to be expected, modulo 2^bits:

    d[k, p] = q[k, p]                                   order 0
    d[k, p] = q[k, p] - q[k - 1, p]                     order 1: it stays
    d[k, p] = q[k, p] - 2 q[k - 1, p] + q[k - 2, p]     order 2: it goes on
    r[k, p] = d[k, p] - d[k, p - 1]                     beside: as the particle before

0 is what is before the first particle and the first frame; before the second frame, the first
counts twice.  Zigzag (0, -1, 1, -2, ... -> 0, 1, 2, 3, ...) turns small differences into small
numbers, whose low bytes come first, then the high ones.

A block holds some frames of all channels, one after the other; the first byte of each is its way,
order + 4 beside.  The block is deflated and written in base64."""

import base64
import zlib
from collections.abc import Sequence
from itertools import product

import numpy as np

WAYS = tuple(product((0, 1, 2), (False, True)))
"""(order, beside)"""


def differences(q: np.ndarray, before: np.ndarray, order: int, beside: bool) -> np.ndarray:
    """r [frames, n] of q [frames, n], uint8 or uint16, after the two frames `before` [2, n]."""
    a = np.concatenate([before, q])
    d = (q, a[2:] - a[1:-1], a[2:] - 2 * a[1:-1] + a[:-2])[order]
    return np.diff(d, axis=1, prepend=d.dtype.type(0)) if beside else d


def byte_planes(r: np.ndarray) -> np.ndarray:
    """Zigzag, low bytes before high ones: uint8 [bytes, values]."""
    signed = r.view(f"i{r.itemsize}")
    zigzag = ((signed << 1) ^ (signed >> (8 * r.itemsize - 1))).astype(f"<u{r.itemsize}")
    return np.ascontiguousarray(zigzag.view(np.uint8).reshape(-1, r.itemsize).T)


def entropy(planes: np.ndarray) -> float:
    """Bits that the bytes take if each has a code of its own, by its frequency in its plane."""
    count = np.stack([np.bincount(plane, minlength=256) for plane in planes])
    share = count / planes.shape[1]
    return -float((count * np.log2(share, where=count > 0, out=np.zeros_like(share))).sum())


class Packer:
    """Packs one block after another; the first holds one frame."""

    def __init__(self):
        self._before: list[np.ndarray] = []

    def pack(self, channels: Sequence[np.ndarray]) -> str:
        """The next frames of each channel [frames, n] -> a block."""
        begins = not self._before
        if begins:
            self._before = [np.zeros_like(q, shape=(2, q.shape[1])) for q in channels]
        # Noise has runs, but nothing to find farther back: looking for it takes 50 times as long.
        deflate = zlib.compressobj(strategy=zlib.Z_RLE, memLevel=9)
        parts = []
        for number, q in enumerate(channels):
            before = self._before[number]
            ways = [(byte_planes(differences(q, before, *way)), *way) for way in WAYS]
            planes, order, beside = min(ways, key=lambda way: entropy(way[0]))
            parts.append(deflate.compress(bytes([order + 4 * beside]) + planes.tobytes()))
            self._before[number] = q[[0, 0]] if begins else np.concatenate([before, q])[-2:]
        return base64.b64encode(b"".join([*parts, deflate.flush()])).decode("ascii")
