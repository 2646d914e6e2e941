"""rara draws 3D Gaussian Splatting scenes by Vulkan, and cuts them exactly."""

from ._rara import Camera, Clip, Gaussians, Mesh, Picture, compare, devices, generate, orbit, path
from .clips import Box, Capsule, Cone, Cylinder, Ellipsoid, Plane, Polygon, Slab, Sphere
from .drawing import Renderer, Shot, section, sweep, truth
from .errors import (
    BudgetError, DeviceError, DeviceLostError, Error, FormatError, InvalidError, IoError, OutOfMemoryError, ValidationError,
    VulkanError,
)
from .gsplat import rasterize
from .scenes import Layer, Scene, bake, from_3dgs, load

__all__ = [
    "BudgetError", "Box", "Camera", "Capsule", "Clip", "Cone", "Cylinder", "DeviceError", "DeviceLostError", "Ellipsoid",
    "Error", "FormatError", "Gaussians", "InvalidError", "IoError", "Layer", "Mesh", "OutOfMemoryError", "Picture", "Plane",
    "Polygon", "Renderer", "Scene", "Shot", "Slab", "Sphere", "ValidationError", "VulkanError", "bake", "compare", "devices",
    "from_3dgs", "generate", "load", "orbit", "path", "rasterize", "section", "sweep", "truth",
]
