# SPDX-License-Identifier: Apache-2.0
"""The depth of every element of a frame, and a picture in which everything is in focus."""
from __future__ import annotations

import dataclasses
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .camera import Camera
from .camera_path import Path
from .errors import UsageError, warn_of_missing
from .keywords import suggests_names
from .light_field import LightField
from .path_arguments import index_of, path_in
from .progress import Progress, checked, telling

# Limits of lf/analysis/focus_stack/focus_planes.h and lf/analysis/depth/depth_map.h.
_LEAST, _MOST, _MOST_PLANES, _MOST_VIEWS, _WIDEST = 1e-9, 1e9, 1024, 4096, 33


@dataclasses.dataclass(frozen=True, eq=False)
class DepthMap:
    """The depth of every element of a frame. :func:`depth_map` returns one.

    Attributes
    ----------
    depth : ndarray of float32 of shape (height, width)
        Distance along the optical axis in world units; NaN where it is unknown.
    confidence : ndarray of float32 of shape (height, width)
        How much better the LF images agree at this distance than at others, from 0 to 1.
    filled : ndarray of float32 of shape (height, width)
        `depth` with a mean of the depths around unknown elements.
    rgb : ndarray of float32 of shape (height, width, 3)
        The picture in which everything is in focus: linear light with sRGB primaries.
    distances : ndarray of shape (n,)
        The distances that were tested.
    image_count : int
        Number of LF images that were compared.
    camera : Camera
        The camera of the frame.
    """

    depth: npt.NDArray[np.float32]
    confidence: npt.NDArray[np.float32]
    filled: npt.NDArray[np.float32]
    rgb: npt.NDArray[np.float32]
    distances: npt.NDArray[np.float64]
    image_count: int
    camera: Camera

    def points(self) -> npt.NDArray[np.float64]:
        """Return the points in the world of the elements, (height, width, 3); NaN where the depth is unknown."""
        height, width = self.depth.shape
        y, x = np.mgrid[:height, :width] + 0.5
        rays = np.stack([x, y, np.ones_like(x)], -1) @ np.linalg.inv(self.camera.K).T
        pose = self.camera.cam_from_world
        points: npt.NDArray[np.float64] = (rays * self.depth[..., None] - pose[:, 3]) @ pose[:, :3]
        return points

    def __repr__(self) -> str:
        height, width = self.depth.shape
        return (f"<DepthMap of {width} x {height}, {100 * np.isfinite(self.depth).mean():.0f} % known, of "
                f"{self.image_count} LF images>")


@suggests_names
def depth_map(field: LightField, camera: Union[Camera, Path], *, near: Optional[float] = None,
              far: Optional[float] = None, planes: Optional[int] = None, views: int = 200, window: int = 5,
              confidence: float = 0.5, clean: bool = False, frame: Optional[int] = None, strict: bool = False,
              memory: str = "8G", threads: int = 0, progress: Progress = None) -> DepthMap:
    """Find the depth of every element of a frame by a plane sweep, as `lffocus depth`.

    Parameters
    ----------
    field : LightField
        The light field.
    camera : Camera or Path
        The camera, or a path. Its lens says which LF cameras are compared; one with fewer than 12 is widened.
    near, far : float, optional
        Nearest and farthest distance that is tested. By default the depths of the scene that the light field states; if
        it states none, LF images are compared.
    planes : int, optional
        Number of distances, even in 1 / distance. By default so many that a point moves by half an element in the
        outermost LF images from one to the next.
    views : int
        Largest number of LF images that are compared, spread evenly over the lens.
    window : int
        Width of the windows over which LF images are compared; odd.
    confidence : float
        Least confidence of a depth, from 0 to 1.
    clean : bool
        True: wrong and missing depths become the median of the depths of the elements of their colour around them, if
        most of these have about the same depth.
    frame : int, optional
        Number of the frame of a path whose camera is used. Default None: the first.
    strict : bool
        True: a broken LF image is an error; False: it is left out, with a warning.
    memory : str
        Memory of the LF images, such as "8G".
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of elements that are done, and their total number.

    Returns
    -------
    DepthMap

    Raises
    ------
    InputError
        Fewer than three LF cameras see the scene, or the depths of the scene are neither stated nor found.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> camera = field.camera(resolution=(80, 60), focus_distance=1)
    >>> lf.depth_map(field, camera, near=0.5, far=2).depth.shape
    (60, 80)
    """
    cameras = path_in(field, camera)
    chosen = cameras[index_of(frame, cameras)]
    width = arguments.whole_within("window", window, 1, _WIDEST)
    if width % 2 == 0:
        raise UsageError(f"window={width}: expected an odd number")
    count = 0 if planes is None else arguments.whole_within("planes", planes, 2, _MOST_PLANES)
    with telling(checked(progress), "elements") as tell:
        depth, sure, filled, rgb, distances, images, skipped = _core.depth_map(
            field._core, chosen._core, _distance("near", near), _distance("far", far), count,
            arguments.whole_within("views", views, 3, _MOST_VIEWS), width,
            arguments.within("confidence", confidence, 0, 1), arguments.flag("clean", clean),
            arguments.flag("strict", strict),
            arguments.memory(memory), arguments.thread_count(threads), tell)
    warn_of_missing([reason for _, reason in skipped])
    return DepthMap(depth, sure, filled, rgb, np.array(distances), images, chosen)


def _distance(name: str, value: Optional[float]) -> Optional[float]:
    return None if value is None else arguments.within(name, value, _LEAST, _MOST)
