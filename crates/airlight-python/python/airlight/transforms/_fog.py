"""Fog of random visibility over pictures, as arrays or tensors."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airlight import _native


class FogRange:
    """A range of visibilities, and the settings that all fog of a transform shares.

    Parameters
    ----------
    visibility_m : float or (float, float)
        Visibility, or the range from which it is drawn, m. Its logarithm is uniform, since fog ten times as thick looks like one
        step at any visibility.
    **settings
        Settings of ``airlight.Fog``, such as ``fov_deg`` and ``depth_scale``.

    Raises
    ------
    ValueError
        For a range that is empty, and settings that ``airlight.Fog`` refuses.
    """

    def __init__(self, visibility_m: float | tuple[float, float] = (50.0, 500.0), **settings: Any) -> None:
        ends = np.broadcast_to(np.asarray(visibility_m, dtype=float), 2)
        self.visibility_m = (float(ends[0]), float(ends[1]))
        self.settings = settings
        if self.visibility_m[0] > self.visibility_m[1]:
            raise ValueError(
                f"visibility_m: expected the least visibility first, got {self.visibility_m[0]} to {self.visibility_m[1]}"
            )
        for end in self.visibility_m:
            self.fog(end)

    def draw(self, number: float) -> float:
        """Visibility, m, for a number from 0 to 1."""
        least, most = self.visibility_m
        return min(max(least * math.exp(number * math.log(most / least)), least), most)

    def fog(self, visibility_m: float) -> _native.Fog:
        """The fog of a visibility."""
        return _native.Fog(visibility_m, **self.settings)


class Fog:
    """Fog of random visibility over pictures with depth, for torchvision's v2 transforms and for anything that calls a function.

    A call takes a picture and its depth, and returns them; a dictionary with ``image`` and ``depth`` comes back as a dictionary
    with its other entries unchanged. Pictures are arrays of shape (height, width, 3) or tensors of shape (3, height, width),
    uint8 (sRGB) or float32 (``linear`` says whether it is light; otherwise sRGB from 0 to 1). Depth has shape (height, width)
    or (1, height, width), in metres times ``depth_scale``, infinite in the sky.

    Parameters
    ----------
    visibility_m : float or (float, float)
        Visibility, or the range from which it is drawn, m.
    p : float
        Probability of fog.
    seed : int or None
        Seed of the draws. None: the generator of torch if it is loaded, which data loaders seed for each worker, otherwise that of
        the module random. With a seed each worker of a data loader draws its own numbers.
    linear : bool
        Whether floats are linear light.
    **settings
        Settings of ``airlight.Fog``, such as ``fov_deg``.

    Examples
    --------
    >>> transform = airlight.transforms.Fog(visibility_m=(50, 500), seed=1)
    >>> foggy, depth = transform(picture, depth)
    """

    def __init__(
        self,
        visibility_m: float | tuple[float, float] = (50.0, 500.0),
        *,
        p: float = 1.0,
        seed: int | None = None,
        linear: bool = False,
        **settings: Any,
    ) -> None:
        if not 0.0 <= p <= 1.0:
            raise ValueError(f"p: expected a probability from 0 to 1, got {p}")
        self.range = FogRange(visibility_m, **settings)
        self.p = p
        self.seed = seed
        self.linear = linear
        self._generator: random.Random | None = None
        self._worker: int | None = None

    def __getstate__(self) -> dict[str, Any]:
        """State without the generator, which each process makes of the seed."""
        return {**self.__dict__, "_generator": None, "_worker": None}

    def __call__(self, image: Any, depth: Any = None) -> Any:
        """Add fog to a picture.

        Parameters
        ----------
        image : numpy.ndarray, torch.Tensor or dict
            The picture, or a dictionary with ``image`` and ``depth``.
        depth : numpy.ndarray or torch.Tensor
            Its depth.

        Returns
        -------
        (image, depth) or dict
        """
        if isinstance(image, dict):
            if "image" not in image or "depth" not in image:
                raise ValueError(f"expected a dictionary with image and depth, got {', '.join(map(str, image))}")
            return {**image, "image": self._foggy(image["image"], image["depth"])}
        if depth is None and isinstance(image, tuple | list) and len(image) == 2:
            image, depth = image
        if depth is None:
            raise ValueError("expected a picture and its depth, got a picture only; try transform(image, depth)")
        return self._foggy(image, depth), depth

    def __repr__(self) -> str:
        settings = "".join(f", {name}={value!r}" for name, value in self.range.settings.items())
        return f"Fog(visibility_m={self.range.visibility_m}, p={self.p}, seed={self.seed}{settings})"

    def _numbers(self) -> tuple[float, float]:
        """Two numbers from 0 to 1: whether there is fog, and how thick it is."""
        torch = _loaded_torch()
        if self.seed is None:
            if torch is not None:
                pair = torch.rand(2, dtype=torch.float64)
                return float(pair[0]), float(pair[1])
            return random.random(), random.random()
        info = torch.utils.data.get_worker_info() if torch is not None else None
        worker = -1 if info is None else info.id
        if self._generator is None or self._worker != worker:
            self._generator, self._worker = random.Random(f"{self.seed} {worker}"), worker
        return self._generator.random(), self._generator.random()

    def _foggy(self, image: Any, depth: Any) -> Any:
        chance, number = self._numbers()
        if chance >= self.p:
            return image
        fog = self.range.fog(self.range.draw(number))
        if isinstance(image, np.ndarray):
            return apply(fog, image, np.asarray(depth), linear=self.linear)
        array = np.ascontiguousarray(np.moveaxis(image.detach().cpu().numpy(), -3, -1))
        distance = depth.detach().cpu().numpy() if hasattr(depth, "detach") else np.asarray(depth)
        torch = _loaded_torch()
        foggy = np.ascontiguousarray(np.moveaxis(apply(fog, array, distance, linear=self.linear), -1, -3))
        tensor = torch.from_numpy(foggy).to(image.device)
        # Subclasses of tensors, such as torchvision's Image, stay what they are.
        return tensor.as_subclass(type(image))


def _loaded_torch() -> Any:
    """The module torch if the program uses it."""
    import sys

    return sys.modules.get("torch")


def apply(fog: _native.Fog, image: NDArray[Any], depth: NDArray[Any], *, linear: bool = False) -> NDArray[Any]:
    """A picture in fog.

    Parameters
    ----------
    fog : airlight.Fog
        The fog.
    image : numpy.ndarray, shape (height, width, 3)
        uint8, uint16 or float32.
    depth : numpy.ndarray, shape (height, width), (height, width, 1) or (1, height, width)
        Depth.
    linear : bool
        Whether floats are linear light; otherwise they are sRGB from 0 to 1.

    Returns
    -------
    numpy.ndarray, shape (height, width, 3)
        In the type of ``image``.
    """
    if depth.ndim == 3 and 1 in (depth.shape[0], depth.shape[2]):
        depth = depth[0] if depth.shape[0] == 1 else depth[..., 0]
    if image.dtype != np.float32 or linear:
        return fog(image, depth)
    return _encode(fog(_decode(image), depth))


def _decode(encoded: NDArray[np.float32]) -> NDArray[np.float32]:
    """Linear light of sRGB (IEC 61966-2-1)."""
    low = encoded / np.float32(12.92)
    high = ((np.maximum(encoded, 0) + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4)
    return np.where(encoded <= 0.04045, low, high)


def _encode(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """The sRGB signal of linear light, from 0 to 1."""
    low = linear * np.float32(12.92)
    high = np.float32(1.055) * np.maximum(linear, 0) ** np.float32(1 / 2.4) - np.float32(0.055)
    return np.clip(np.where(linear <= 0.0031308, low, high), 0, 1).astype(np.float32)
