"""Fog for training pictures: physical, by the depth of each pixel, with the visibility in metres.

``airlight.transforms.Fog`` works on NumPy arrays and torch tensors, and in ``torchvision.transforms.v2.Compose``;
``airlight.transforms.albumentations.Fog`` is the same transform for ``albumentations.Compose``.
"""

from airlight.transforms._fog import Fog, FogRange

__all__ = ["Fog", "FogRange"]
