"""Fog for albumentations 2; needs that package."""

from __future__ import annotations

from typing import Any

import numpy as np
from albumentations.core.transforms_interface import ImageOnlyTransform
from numpy.typing import NDArray

from airlight.transforms._fog import FogRange, apply


class Fog(ImageOnlyTransform):
    """Fog of random visibility, by the depth of each pixel.

    The depth is passed as ``depth``; declare it with ``additional_targets={"depth": "mask"}``, so that crops and flips act on it
    too. Draws come from the generators of albumentations, which ``Compose`` seeds, for each worker of a data loader too.

    Parameters
    ----------
    visibility_m : float or (float, float)
        Visibility, or the range from which it is drawn, m.
    p : float
        Probability of fog.
    linear : bool
        Whether pictures of float32 are linear light; otherwise they are sRGB from 0 to 1.
    **settings
        Settings of ``airlight.Fog``, such as ``fov_deg``.

    Examples
    --------
    >>> import albumentations
    >>> fog = Fog(visibility_m=(50, 500), p=1.0, fov_deg=70)
    >>> pipeline = albumentations.Compose([fog], additional_targets={"depth": "mask"}, seed=1)
    >>> foggy = pipeline(image=picture, depth=depth)["image"]
    """

    def __init__(
        self,
        visibility_m: float | tuple[float, float] = (50.0, 500.0),
        p: float = 0.5,
        *,
        linear: bool = False,
        **settings: Any,
    ) -> None:
        super().__init__(p=p)
        self.range = FogRange(visibility_m, **settings)
        self.linear = linear

    @property
    def targets_as_params(self) -> list[str]:
        """Targets that the fog depends on."""
        return ["depth"]

    def get_params_dependent_on_data(self, params: dict[str, Any], data: dict[str, Any]) -> dict[str, Any]:
        """Draws the visibility.

        Parameters
        ----------
        params, data : dict
            Those of albumentations.

        Returns
        -------
        dict
        """
        del params
        visibility_m = self.range.draw(self.py_random.random())
        return {"visibility_m": visibility_m, "depth": data["depth"]}

    def apply(self, img: NDArray[Any], visibility_m: float, depth: NDArray[Any], **params: Any) -> NDArray[Any]:
        """A picture in fog.

        Parameters
        ----------
        img : numpy.ndarray, shape (height, width, 3)
            The picture.
        visibility_m : float
            Visibility, m.
        depth : numpy.ndarray, shape (height, width)
            Its depth.
        **params
            Not used.

        Returns
        -------
        numpy.ndarray, shape (height, width, 3)
        """
        del params
        return apply(self.range.fog(visibility_m), np.ascontiguousarray(img), np.asarray(depth), linear=self.linear)

    def to_dict_private(self) -> dict[str, Any]:
        """Settings for serialization."""
        return {
            "__class_fullname__": self.get_class_fullname(),
            "visibility_m": self.range.visibility_m,
            "p": self.p,
            "linear": self.linear,
            **self.range.settings,
        }
