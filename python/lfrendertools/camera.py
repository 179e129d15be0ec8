# SPDX-License-Identifier: Apache-2.0
"""Thin-lens cameras."""
from __future__ import annotations

import math
import os
import re
from typing import TYPE_CHECKING, Any, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .errors import InputError, UsageError
from .keywords import suggests_names
from .path_text import text_of_camera

if TYPE_CHECKING:
    from .light_field import LightField

Floats = npt.NDArray[np.float64]
Vector = Union[Sequence[float], Floats]
# The numbers of a camera that decide what its elements see: calibration, resolution and pose come first.
_VIEW_NUMBERS = 19


class Camera:
    """A thin-lens camera that takes one frame.

    Lengths are world units, unless a name ends in `_mm`. World axes are those of the light field; the axes of a camera
    are x to the right, y down, z forward. A camera cannot be changed: :meth:`replace` makes a changed copy.

    Parameters
    ----------
    position : array_like of shape (3,)
        Centre of the lens in the world.
    look_at, quaternion, world_from_cam : array_like
        The direction of the camera: a point on the optical axis; the rotation from camera to world as (w, x, y, z);
        or this rotation as a matrix (3, 3). One of them is required.
    up : array_like of shape (3,), optional
        A world direction that points up in the picture, by default (0, -1, 0). Only with `look_at`.
    roll_deg : float, optional
        A turn about the optical axis, clockwise for the photographer.
    resolution : tuple of int
        Width and height of the frame in elements.
    focal_length_mm, field_of_view_deg : float
        Focal length, or horizontal field of view. One of them is required.
    sensor_width_mm : float, optional
        Width of the sensor plate.
    shift_mm : tuple of float, optional
        How far the middle of the picture is to the right of the optical axis and above it, on the sensor plate. A
        positive shift shows more of what is on the right and above, without turning the camera.
    f_number, aperture_diameter, aperture_diameter_mm : float
        Opening of the lens. One of them is required; a diameter of 0 is a pinhole.
    focus_distance, focus_point : float, array_like
        Distance of the focus plane along the optical axis, or a point (3,) on this plane. One of them is required.
    tilt_deg : tuple of float, optional
        Horizontal and vertical tilt of the focus plane. If positive, the right and the upper side of the
        plane are farther away.
    blades : int, optional
        0: the aperture is a circle; 3 to 64: a regular polygon.
    blade_rotation_deg : float, optional
        Rotation of the polygon, counter-clockwise for the photographer.
    blade_roundness : float, optional
        0: blades are straight; 1: they form the circle; between: arcs.
    ratio : float, optional
        Height of the opening divided by its width, from 0.1 to 10, as of an anamorphic lens. The longer side has the
        diameter of the aperture.
    hood : tuple of float, optional
        Distance from the lens, and diameter, of a round opening in front of the lens, which cuts off oblique rays:
        lights in the corners have the shape of a cat's eye. (0, 0): there is none.
    transmission : str, path-like or array_like of shape (height, width) or (height, width, 1), optional
        How much light each place of the opening lets through: the file of a picture, the text of a path file such as
        "00ff/ff00", shares from 0 to 1, or whole numbers of the type uint8 up to 255. The picture is a square around
        the opening, upright for the photographer behind the camera; it is reduced to at most 64 x 64 places.
        Out-of-focus lights have its shape.
    breathing : bool, optional
        True: the field of view narrows when the focus comes nearer. False: focusing does not change it.
    unit_m : float, optional
        Metres per world unit. A render requires the value of its light field.

    Raises
    ------
    UsageError
        Arguments are missing, contradict each other, or are out of range.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(640, 360), focal_length_mm=50, f_number=2,
    ...                    focus_distance=1)
    >>> camera.aperture_diameter
    0.025
    >>> round(camera.replace(f_number=4).aperture_diameter, 6)
    0.0125
    """

    __slots__ = ("_core",)

    @suggests_names
    def __init__(self, position: Vector, *, look_at: Optional[Vector] = None, quaternion: Optional[Vector] = None,
                 world_from_cam: Optional[npt.ArrayLike] = None, up: Optional[Vector] = None, roll_deg: float = 0,
                 resolution: Tuple[int, int], focal_length_mm: Optional[float] = None,
                 field_of_view_deg: Optional[float] = None, sensor_width_mm: float = 36,
                 shift_mm: Tuple[float, float] = (0, 0), f_number: Optional[float] = None,
                 aperture_diameter: Optional[float] = None, aperture_diameter_mm: Optional[float] = None,
                 focus_distance: Optional[float] = None, focus_point: Optional[Vector] = None,
                 tilt_deg: Tuple[float, float] = (0, 0), blades: int = 0, blade_rotation_deg: float = 0,
                 blade_roundness: float = 0, ratio: float = 1, hood: Tuple[float, float] = (0, 0),
                 transmission: Union[None, str, "os.PathLike[str]", npt.ArrayLike] = None,
                 breathing: bool = False, unit_m: float = 1) -> None:
        _one_of(look_at=look_at, quaternion=quaternion, world_from_cam=world_from_cam)
        _one_of(focal_length_mm=focal_length_mm, field_of_view_deg=field_of_view_deg)
        _one_of(f_number=f_number, aperture_diameter=aperture_diameter, aperture_diameter_mm=aperture_diameter_mm)
        _one_of(focus_distance=focus_distance, focus_point=focus_point)
        if position is None:
            raise TypeError("position=None: expected 3 numbers")
        if up is None:
            up = (0, -1, 0)
        elif look_at is None:
            raise UsageError(f"up={up!r}: is used only with look_at")
        if world_from_cam is not None:
            quaternion = _quaternion_of(arguments.reals("world_from_cam", world_from_cam))
        camera = {"position": position, "look_at": look_at, "quaternion": quaternion, "roll_deg": roll_deg or None,
                  "up": up if look_at is not None else None, "focal_length_mm": focal_length_mm,
                  "field_of_view_deg": field_of_view_deg, "sensor_width_mm": sensor_width_mm, "shift_mm": shift_mm}
        lens = {"f_number": f_number, "aperture_diameter": aperture_diameter,
                "aperture_diameter_mm": aperture_diameter_mm, "focus_distance": focus_distance,
                "focus_point": focus_point, "focus_tilt_deg": tilt_deg, "blades": blades,
                "blade_rotation_deg": blade_rotation_deg, "blade_roundness": blade_roundness, "ratio": ratio,
                "breathing": arguments.flag("breathing", breathing), **_hood_of(hood)}
        text = text_of_camera(unit_m, resolution, camera, lens)
        if transmission is not None:
            text += f'  transmission: "{_transmission_text(transmission)}"\n'
        try:
            cameras, _, _, _, _ = _core.parse_path(text, "camera", None)
        except InputError as error:
            # A position in this text would say nothing to the caller.
            words = re.sub(r"^camera:\d+:\d+: (?:camera\.|lens\.)?| \(also wrong: line.*\)$", "", str(error))
            raise UsageError(words.replace("focus_tilt_deg", "tilt_deg")) from None
        self._core: _core.RenderCamera = cameras[0]

    @classmethod
    def _of(cls, core: _core.RenderCamera) -> Camera:
        camera = cls.__new__(cls)
        camera._core = core
        return camera

    @property
    def resolution(self) -> Tuple[int, int]:
        """Width and height of the frame in elements."""
        return self._core.resolution

    @property
    def position(self) -> Floats:
        """Centre of the lens in the world, of shape (3,)."""
        return self._core.position

    @property
    def cam_from_world(self) -> Floats:
        """[R|t], of shape (3, 4), which maps world points to camera axes."""
        return self._core.cam_from_world

    @property
    def K(self) -> Floats:
        """Calibration matrix for rays through the lens centre, of shape (3, 3), in elements of the frame."""
        return self._core.K

    @property
    def aperture_diameter(self) -> float:
        """Diameter of the opening in world units."""
        return self._core.aperture_diameter

    @property
    def f_number(self) -> float:
        """Focal length divided by the diameter of the opening; infinite for a pinhole."""
        diameter = self._core.aperture_diameter
        return self._core.focal_length / diameter if diameter > 0 else math.inf

    @property
    def focal_length_mm(self) -> float:
        """Focal length in millimetres."""
        return self._core.focal_length * self._core.unit_m * 1000

    @property
    def focus_distance(self) -> float:
        """Distance of the focus plane along the optical axis, in world units."""
        return self._core.focus_distance

    @property
    def focus_plane(self) -> Tuple[Floats, float]:
        """Normal of length 1 and offset of the focus plane: its points X in the world have normal . X = offset."""
        return self._core.focus_plane

    @property
    def tilt_deg(self) -> Tuple[float, float]:
        """Horizontal and vertical tilt of the focus plane."""
        return self._core.tilt_deg

    @property
    def blades(self) -> int:
        """Number of blades of the aperture; 0 for a circle."""
        return self._core.blades

    @property
    def blade_rotation_deg(self) -> float:
        """Rotation of the polygon of blades, counter-clockwise for the photographer."""
        return self._core.blade_rotation_deg

    @property
    def blade_roundness(self) -> float:
        """0: blades are straight; 1: they form a circle."""
        return self._core.blade_roundness

    @property
    def ratio(self) -> float:
        """Height of the opening divided by its width."""
        return self._core.ratio

    @property
    def hood(self) -> Tuple[float, float]:
        """Distance from the lens, and diameter, of the hood in world units; (0, 0): there is none."""
        return self._core.hood

    @property
    def transmission(self) -> Optional[Floats]:
        """Shares of the light that the places of the opening let through, (side, side); None: all of it."""
        text = self._core.transmission
        if not text:
            return None
        rows = [np.frombuffer(bytes.fromhex(row), np.uint8) for row in text.split("/")]
        return np.stack(rows) / 255

    @property
    def shift_mm(self) -> Tuple[float, float]:
        """How far the middle of the picture is to the right of the optical axis, and above it, on the sensor plate."""
        right, up = self._core.shift
        return right * self._core.unit_m * 1000, up * self._core.unit_m * 1000

    @property
    def unit_m(self) -> float:
        """Metres per world unit."""
        return self._core.unit_m

    @property
    def surface(self) -> Optional[npt.NDArray[np.float32]]:
        """Depths of the focal surface at the elements, (height, width); None: the camera is in focus on a plane."""
        return self._core.surface_depths()

    def with_surface(self, depths: Optional[npt.ArrayLike], field: Optional[LightField] = None, *,
                     blur: float = 0.5) -> Camera:
        """Return a copy that is in focus on a surface in place of the focus plane.

        Each element is in focus at its own depth: with the depths of a subject, all of it is sharp, and everything
        before and behind it is blurred. The focus distance of the camera then focuses nothing.

        Parameters
        ----------
        depths : array_like of shape (height, width) or None
            Depth of each element along the optical axis, in world units, seen from this camera, such as
            :attr:`DepthMap.depth`. Elements without a depth (0, negative, infinite or NaN) take that of the nearest
            element that has one. None: the copy is in focus on its plane.
        field : LightField, optional
            The light field that is rendered. It matters for lenses that are narrower than two distances between LF
            cameras, which take light from so many: without it, the surface of a narrow lens is coarse.
        blur : float, optional
            Largest blur of an element by the pieces of the surface, in elements, from 0.01 to 100: smaller values take
            more pieces and more time.

        Returns
        -------
        Camera

        Raises
        ------
        UsageError
            The depths have another shape than the frame, no element has a depth, or `blur` is out of range.

        Examples
        --------
        >>> import lfrendertools as lf
        >>> import numpy as np
        >>> camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(64, 36), focal_length_mm=50, f_number=2,
        ...                    focus_distance=1)
        >>> camera.with_surface(np.full((36, 64), 0.75)).surface[0, 0]
        0.75
        """
        if depths is None:
            core = self._core
            return Camera._of(_core.RenderCamera.of_numbers(core.numbers(), core.transmission, b""))
        values = arguments.reals("depths", depths)
        width, height = self.resolution
        if values.shape != (height, width):
            raise UsageError(f"depths: the shape is {values.shape}, expected ({height}, {width}), one depth for each "
                             "element of the frame")
        size = arguments.real("blur", blur)
        if not 0.01 <= size <= 100:
            raise UsageError(f"blur={blur!r}: expected a number of elements from 0.01 to 100")
        distance = 0.0 if field is None else field._core.nearest_distance()
        return Camera._of(self._core.with_surface(np.ascontiguousarray(values), size, distance))

    def _settings(self) -> Dict[str, Any]:
        core = self._core
        width = core.resolution[0]
        return {"position": core.position, "world_from_cam": core.cam_from_world[:, :3].T,
                "resolution": core.resolution,
                "field_of_view_deg": math.degrees(2 * math.atan(width / (2 * core.K[0, 0]))),
                "sensor_width_mm": core.sensor_width * core.unit_m * 1000, "shift_mm": self.shift_mm,
                "aperture_diameter": core.aperture_diameter,
                "focus_distance": core.focus_distance, "tilt_deg": core.tilt_deg, "blades": core.blades,
                "blade_rotation_deg": core.blade_rotation_deg, "blade_roundness": core.blade_roundness,
                "ratio": core.ratio, "hood": core.hood, "transmission": self.transmission, "unit_m": core.unit_m}

    def replace(self, **changes: Any) -> Camera:
        """Return a copy with some arguments of the constructor changed.

        If only the resolution changes, the horizontal field of view stays. The copy of a camera with `breathing` has
        its present field of view and does not breathe, unless `breathing` is given. A focal surface is kept.

        Parameters
        ----------
        **changes
            Arguments of :class:`Camera`. One that excludes another, such as `f_number` and `aperture_diameter`,
            replaces it.

        Returns
        -------
        Camera

        Raises
        ------
        UsageError
            As for :class:`Camera`; or the camera has a focal surface, and the copy would see it from elsewhere or with
            other elements.
        """
        if not changes:
            return self
        values = self._settings()
        unchanged = Camera(**values)
        for default, others in (("world_from_cam", ("look_at", "quaternion")),
                                ("field_of_view_deg", ("focal_length_mm",)),
                                ("aperture_diameter", ("aperture_diameter_mm", "f_number")),
                                ("focus_distance", ("focus_point",))):
            if any(changes.get(other) is not None for other in others):
                del values[default]
        values.update(changes)
        # Numbers that do not change keep their bits, which the arguments of the constructor state only up to rounding.
        changed = Camera(**values)
        numbers = [old if was == is_now and math.isclose(old, was, rel_tol=1e-9, abs_tol=1e-9) else is_now
                   for old, was, is_now in zip(*(camera._core.numbers() for camera in (self, unchanged, changed)))]
        surface = self._core.surface
        if surface and tuple(numbers[:_VIEW_NUMBERS]) != self._core.numbers()[:_VIEW_NUMBERS]:
            raise UsageError("the camera has a focal surface, whose depths are seen from this camera alone: change "
                             "camera.with_surface(None), and give the copy a surface of its own")
        return Camera._of(_core.RenderCamera.of_numbers(tuple(numbers), changed._core.transmission, surface))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and bool(self._core == other._core)

    def __hash__(self) -> int:
        return hash(self._core)

    def __reduce__(self) -> Any:
        return Camera._of, (self._core,)

    def __repr__(self) -> str:
        x, y, z = self.position
        width, height = self.resolution
        return (f"<Camera {width} x {height} at ({x:.4g}, {y:.4g}, {z:.4g}), focus {self.focus_distance:.4g}, "
                f"aperture {self.aperture_diameter:.4g}>")


def _hood_of(hood: Tuple[float, float]) -> Dict[str, float]:
    """Return the entries of a path file."""
    values = arguments.reals("hood", hood)
    if values.shape != (2,):
        raise UsageError(f"hood={hood!r}: expected a distance and a diameter")
    return {"hood_distance": float(values[0]), "hood_diameter": float(values[1])} if values.any() else {}


def _transmission_text(transmission: Union[str, "os.PathLike[str]", npt.ArrayLike]) -> str:
    """Return the value of `transmission` in a path file."""
    # The text of a transmission has no dot, and the name of a picture has one, as in path files.
    if isinstance(transmission, str) and "." not in transmission and not os.path.exists(transmission):
        try:
            return _core.transmission_of_text(transmission)
        except InputError as error:
            raise UsageError(f"transmission={transmission!r} is no file, and as the text of a transmission: {error}"
                             ) from None
    if isinstance(transmission, (str, os.PathLike)):
        return _core.transmission_of_file(arguments.file_name("transmission", transmission))
    shares = np.asarray(transmission)
    if shares.ndim == 3 and shares.shape[2] == 1:
        shares = shares[..., 0]
    if shares.ndim != 2 or shares.size == 0:
        raise UsageError(f"transmission: expected a file, or an array of shape (height, width) or (height, width, 1), "
                         f"found the shape {shares.shape}")
    if shares.dtype != np.uint8:
        reals = arguments.reals("transmission", shares)
        if not (reals.min() >= 0 and reals.max() <= 1):
            raise UsageError(f"transmission: expected shares from 0 to 1, found {reals.min()} to {reals.max()}")
        shares = np.rint(255 * reals).astype(np.uint8)
    try:
        return _core.transmission_of_array(np.ascontiguousarray(shares))
    except InputError as error:
        raise UsageError(f"transmission: {error}") from None


def _one_of(**arguments: Any) -> None:
    given = [name for name, value in arguments.items() if value is not None]
    if len(given) == 1:
        return
    names = " or ".join(arguments)
    found = " and ".join(given) if given else "none of them"
    raise UsageError(f"expected {names}, found {found}")


def _quaternion_of(rotation: Floats) -> Floats:
    """Return the rotation as (w, x, y, z)."""
    if rotation.shape != (3, 3):
        raise UsageError(f"world_from_cam: expected a matrix of shape (3, 3), found {rotation.shape}")
    error = np.abs(rotation @ rotation.T - np.eye(3)).max()
    if not error < 1e-6 or np.linalg.det(rotation) < 0:
        raise UsageError("world_from_cam: expected a rotation: columns of length 1 that are perpendicular and "
                         "right-handed")
    # The eigenvector of the largest eigenvalue is accurate for every rotation (Bar-Itzhack 2000).
    r = rotation
    matrix = np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
        [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
        [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]]])
    x, y, z, w = np.linalg.eigh(matrix, UPLO="L")[1][:, -1]
    quaternion = np.array([w, x, y, z])
    return quaternion if w >= 0 else -quaternion
