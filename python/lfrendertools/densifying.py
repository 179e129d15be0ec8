# SPDX-License-Identifier: Apache-2.0
"""Virtual LF images in the lenses of a film, as `lfdensify` makes them."""
from __future__ import annotations

import json
import os
import warnings
from typing import List, Optional, Tuple, Union

from . import _core, arguments, opening
from .arguments import FilePath
from .camera import Camera
from .camera_path import Path
from .errors import MissingImagesWarning, UsageError, caller_level
from .keywords import suggests_names
from .light_field import LightField
from .path_arguments import path_in
from .progress import Progress, checked, telling


@suggests_names
def densify(field: LightField, store: FilePath, path: Union[None, Camera, Path] = None, *, spacing: float = 1.5,
            most: int = 2000, divisor: int = 1, depths: Optional[Tuple[float, float]] = None, force: bool = False,
            resume: bool = False, overwrite: bool = False, strict: bool = False, memory: str = "2G",
            cache: Optional[FilePath] = None, threads: int = 0, progress: Progress = None) -> LightField:
    """Put virtual LF images between recorded ones, as `lfdensify` does.

    What is out of focus in a film of few photographs appears as copies, one for each LF image. Virtual LF images fill
    the gaps, so that it is blurred. A test comes first: LF images are left out and made from their neighbours.

    Parameters
    ----------
    field : LightField
        The light field, as it was recorded.
    store : path
        The packed store to write; its name ends in `.lfs`.
    path : Camera or Path, optional
        The film: virtual LF images fill its lenses, for any arrangement of LF cameras. By default they are made
        wherever LF cameras are around, which must then look in one direction, or at one point from one side.
    spacing : float
        Largest distance between the copies in a blur, in elements of the frames, from 0.25 to 16.
    most : int
        Make at most so many virtual LF images; if more are needed, they stand less densely.
    divisor : int
        Reduce depths and virtual LF images to 1/`divisor` of the size of LF images, from 1 to 16.
    depths : tuple of float, optional
        Nearest and farthest depth of the scene in world units; by default they are found.
    force : bool
        True: densify even if the test speaks against it.
    resume, overwrite : bool
        Continue an unfinished store, or replace a store. Not both.
    strict : bool
        True: an LF image that cannot be read is an error; False: it is left out, with a warning.
    memory : str
        Memory for LF images that are kept, such as "2G".
    cache : path, optional
        Folder in which depths are kept for other paths; "none": they are not kept. By default it is beside the light
        field, if you own the folder there.
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the work that is done, and all work, in comparisons of pixels.

    Returns
    -------
    LightField
        The store, with recorded and virtual LF images (`is_virtual`). :func:`film` renders it.

    Raises
    ------
    InputError
        The light field is dense enough, or it cannot be densified; the message says why.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> dense = lf.densify(field, "dense.lfs", field.camera(aperture_diameter=0.05), spacing=0.5, most=40, force=True)
    >>> len(dense) > len(field)
    True
    """
    words = _core.DensifyWords()
    words.output = arguments.file_name("store", store)
    if os.path.splitext(os.fsencode(store))[1] != b".lfs":
        raise UsageError(f"store={os.fsdecode(store)!r}: expected a file name that ends in .lfs")
    for name, value in (("force", force), ("resume", resume), ("overwrite", overwrite), ("strict", strict)):
        setattr(words, name, arguments.flag(name, value))
    if words.resume and words.overwrite:
        raise UsageError("resume and overwrite cannot both be True")
    words.spacing = arguments.within("spacing", spacing, 0.25, 16)
    words.most = arguments.whole_within("most", most, 1, 1_000_000)
    words.divisor = arguments.whole_within("divisor", divisor, 1, 16)
    if depths is not None:
        near, far = arguments.numbers("depths", depths, 2, 2)
        if not 0 < near < far:
            raise UsageError(f"depths={depths!r}: expected the nearest depth, then the farthest, both above 0")
        words.depths = (near, far)
    words.memory = arguments.memory(memory)
    words.cache = b"" if cache is None else arguments.file_name("cache", cache)
    if not isinstance(field, LightField):
        raise TypeError(f"expected a light field of lf.open(), found {field!r}")
    frames: List[_core.RenderCamera] = []
    if path is not None:
        film = path_in(field, path)
        frames = [camera._core for camera in film] if film._shutter is None else film._shutter[2]
    with telling(checked(progress), "comparisons") as tell:
        facts = json.loads(_core.densify(field._core, os.fsencode(field.source), frames, words,
                                         arguments.thread_count(threads), tell))
    if facts["skipped"]:
        first = facts["skipped"][0]
        warnings.warn(f"{len(facts['skipped'])} of the LF images are left out, the first: {first['lf_image']}: "
                      f"{first['reason']}", MissingImagesWarning, stacklevel=caller_level())
    return opening.open(store)
