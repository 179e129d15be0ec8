# SPDX-License-Identifier: Apache-2.0
"""Whole captures: reports, forecasts and packages, packed stores, and synthetic light fields."""
from __future__ import annotations

import json
import os
import sys
import warnings
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from . import _core, arguments, opening
from .arguments import FilePath
from .camera import Camera
from .camera_path import Path
from .errors import MissingImagesWarning, UsageError, caller_level
from .film_options import film_words
from .keywords import suggests_names
from .light_field import LightField
from .path_arguments import Frames, frame_numbers, path_in
from .progress import Progress, checked, telling

_Facts = Dict[str, Any]


@suggests_names
def report(field: LightField, *, check: str = "headers", distance: Optional[float] = None, threads: int = 0,
           progress: Progress = None) -> _Facts:
    """Report what a light field contains, and what looks wrong in it, as `lfimport` does.

    Parameters
    ----------
    field : LightField
        The light field.
    check : {"headers", "pixels", "none"}
        How image files are checked: their headers, all of their pixels, or not at all.
    distance : float, optional
        Distance to the scene in world units, for the density of the capture; by default that of the calibration.
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of LF images that were checked, and their total number. True: a progress bar, if tqdm is
        installed.

    Returns
    -------
    dict
        The facts that doc/formats/import_report.md lists.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> facts = lf.report(lf.open("capture/"))
    >>> facts["images"], facts["missing"], facts["broken"]
    (49, 0, 0)
    """
    with telling(checked(progress)) as tell:
        return _facts(_core.report(_checked(field)._core, os.fsencode(field.source),
                                   arguments.choice("check", check, ("headers", "pixels", "none")),
                                   None if distance is None else arguments.positive("distance", distance),
                                   arguments.thread_count(threads), tell))


def forecast(field: LightField, path: Union[Path, Camera], frames: Frames = None, *,
             depths: Optional[Tuple[float, float]] = None, memory: str = "8G", threads: int = 0,
             progress: Progress = None, **options: Any) -> _Facts:
    """Forecast time and memory of a render, and whether the capture is dense enough for it, as `lfpreprocessor --plan`.

    Parameters
    ----------
    field : LightField
        The light field.
    path : Path or Camera
        The cameras of the frames.
    frames : str or iterable of int, optional
        Frames to render, by their numbers; by default all.
    depths : tuple of float, optional
        Nearest and farthest depth of the scene in world units. By default the depths of the calibration or, if it has
        none, depths that are estimated from LF images.
    memory : str
        Memory that the render may use, such as "8G" or "512M".
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of steps that are done, and their total number: two for each frame.
    **options
        Options of :class:`Renderer` that decide which LF images frames read.

    Returns
    -------
    dict
        The facts that doc/formats/forecast.md lists. `depths_from` is "depths" if that argument was given.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> facts = lf.forecast(field, field.camera(), depths=(0.4, 3))
    >>> facts["frames"][0]["cameras_in_lens"] > 1
    True
    """
    words = _core.PackageWords()
    words.memory = arguments.memory(memory)
    return _preprocess(field, path, frames, words, depths, threads, checked(progress), options)


def write_packages(field: LightField, path: Union[Path, Camera], folder: FilePath, count: Optional[int] = None, *,
                   frames: Frames = None, frames_per_package: Optional[int] = None, balance: str = "rays",
                   overwrite: bool = False, strict: bool = False, depths: Optional[Tuple[float, float]] = None,
                   memory: str = "8G", threads: int = 0, progress: Progress = None, **options: Any) -> _Facts:
    """Divide a film into packages, which `lfrenderer` and `lfsubmit` render on any machine.

    Parameters
    ----------
    field, path, depths, memory, threads, progress
        As for :func:`forecast`.
    folder : path
        Folder of the packages, which appear together when all are complete.
    count : int, optional
        Number of packages; by default as few as `memory` allows.
    frames : str or iterable of int, optional
        Frames to pack, by their numbers; by default all.
    frames_per_package : int, optional
        Number of frames of a package, instead of `count`.
    balance : {"rays", "frames"}
        Quantity that is about equal in all packages.
    overwrite : bool
        True: replace packages in the folder.
    strict : bool
        True: a missing LF image is an error; False: a warning.
    **options
        Options of :class:`Renderer` that decide which LF images frames read.

    Returns
    -------
    dict
        The facts that doc/formats/forecast.md lists.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> facts = lf.write_packages(field, field.path("orbit", focus_distance=1), "packages", 2)
    >>> [package["name"] for package in facts["packages"]]
    ['package-0000', 'package-0001']
    """
    if count is not None and frames_per_package is not None:
        raise UsageError("count and frames_per_package cannot both be given")
    words = _core.PackageWords()
    words.output = arguments.file_name("folder", folder)
    words.memory = arguments.memory(memory)
    words.balance = arguments.choice("balance", balance, ("rays", "frames"))
    words.packages = _at_least_1("count", count)
    words.frames_per_package = _at_least_1("frames_per_package", frames_per_package)
    words.overwrite = arguments.flag("overwrite", overwrite)
    words.strict = arguments.flag("strict", strict)
    facts = _preprocess(field, path, frames, words, depths, threads, checked(progress), options)
    if facts["lf_images_missing"]:
        warnings.warn(f"{facts['lf_images_missing']} of the LF images that packages need do not exist, or are empty",
                      MissingImagesWarning, stacklevel=caller_level())
    return facts


PROFILES = ("default", "lossless", "thesis", "recorded", "group", "group-lossless", "auto")


@suggests_names
def compress(field: LightField, store: FilePath, *, profile: str = "default", threshold: Optional[float] = None,
             target_psnr: Optional[float] = None, levels: Optional[int] = None, quantizer: str = "8bit",
             entropy: str = "auto", reencode: bool = False, demosaic: str = "none", shard_size: str = "",
             resume: bool = False, overwrite: bool = False, verify: bool = False, strict: bool = False,
             threads: int = 0, progress: Progress = None) -> _Facts:
    """Compress the LF images into a packed store, as `lfcompressor` does.

    Parameters
    ----------
    field : LightField
        The light field.
    store : path
        The file to write; its name ends in `.lfs`. :func:`open` opens it.
    profile : {"default", "lossless", "thesis", "recorded", "group", "group-lossless", "auto"}
        How LF images are encoded. "recorded" keeps image files as they are; "default" and "lossless" keep those that
        are smaller than their encoded images. "group" and "group-lossless" predict LF images from others nearby
        where that saves a tenth: about half the bytes for clean captures, and about four times as long to decode.
        "auto" tries a sample: it takes "group" if prediction saves a tenth of the bytes, otherwise "default", or
        "recorded" if all files are smaller.
    threshold : float, optional
        Wavelet coefficients below it, in 1/255 of the range of values, are dropped; by default that of the profile.
    target_psnr : float, optional
        Find the threshold with which a sample of the LF images has this quality, in dB.
    levels : int, optional
        Levels of the wavelet transform, 1 to 5; by default those of the profile.
    quantizer : str
        For the profile "thesis": "8bit", or the number of values of a coefficient.
    entropy : {"auto", "packed", "contexts"}
        How wavelet coefficients become bytes. "contexts" takes 3 to 29 % fewer bytes for the same pixels, and two
        to three times as long to decode. Not for the profile "thesis". "auto": "contexts" for LF images in groups,
        "packed" for others.
    reencode : bool
        True: encode all LF images, also those whose files are smaller.
    demosaic : {"none", "joint"}
        "joint": make RGB LF images of mosaics. Missing colours are taken from what neighbouring LF images recorded.
        Not with the profiles "recorded" and "auto".
    shard_size : str
        Such as "4G": split the store into files of about this size.
    resume, overwrite : bool
        Continue an unfinished store, or replace a store. Not both.
    verify : bool
        True: read the store back, and compare it.
    strict : bool
        True: an LF image that cannot be read is an error; False: it is left out, with a warning.
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of LF images that were encoded, and their total number; then, from 0 again, with those
        that were verified. The profile "auto" first counts the LF images of its sample, and the demosaicking "joint"
        those that it has looked at. True: a bar for each.

    Returns
    -------
    dict
        The report that `lfcompressor --json` prints.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> facts = lf.compress(lf.open("capture/"), "capture.lfs", target_psnr=40)
    >>> facts["ratio"] > 2, lf.open("capture.lfs")
    (True, <LightField ...capture.lfs: 49 LF images>)
    """
    words = _core.StoreWords()
    words.output = arguments.file_name("store", store)
    if os.path.splitext(os.fsencode(store))[1] != b".lfs":
        raise UsageError(f"store={os.fsdecode(store)!r}: expected a file name that ends in .lfs")
    words.shard_size = arguments.text("shard_size", shard_size)
    for name, value in (("resume", resume), ("overwrite", overwrite), ("verify", verify), ("strict", strict)):
        setattr(words, name, arguments.flag(name, value))
    if words.resume and words.overwrite:
        raise UsageError("resume and overwrite cannot both be True")
    codec = _core.CodecWords()
    codec.profile = arguments.choice("profile", profile, PROFILES)
    codec.quantizer = arguments.text("quantizer", quantizer)
    codec.entropy = arguments.choice("entropy", entropy, ("auto", "packed", "contexts"))
    codec.reencode = arguments.flag("reencode", reencode)
    codec.demosaic = arguments.choice("demosaic", demosaic, ("none", "joint"))
    if threshold is not None and target_psnr is not None:
        raise UsageError("threshold and target_psnr cannot both be given")
    if threshold is not None:
        codec.threshold = arguments.within("threshold", threshold, 0, 255)
    if target_psnr is not None:
        codec.target_psnr = arguments.within("target_psnr", target_psnr, 10, 90)
    if levels is not None:
        codec.levels = arguments.whole_within("levels", levels, 1, 5)
    with telling(checked(progress)) as tell:
        facts = _facts(_core.compress(_checked(field)._core, os.fsencode(field.source), codec, words,
                                      arguments.thread_count(threads), tell))
    if facts["lf_images_skipped"]:
        first = facts["skipped"][0]
        warnings.warn(f"{_images(facts['lf_images_skipped'])} not in the store, the first: {first['reason']}",
                      MissingImagesWarning, stacklevel=caller_level())
    return facts


@suggests_names
def synth(scene: str, folder: FilePath, *, capture: str = "planar", count: Optional[int] = None,
          size: Optional[Tuple[int, int]] = None, spacing: Optional[float] = None, distance: Optional[float] = None,
          jitter: float = 0, format: str = "exr", alpha: str = "none", bayer: bool = False, noise: float = 0,
          distortion: Sequence[float] = (), fisheye: Sequence[float] = (), fov: float = 0,
          samples: Optional[int] = None, truth: Union[None, FilePath, Path] = None, truth_samples: Optional[int] = None,
          calibration_only: bool = False, overwrite: bool = False, seed: int = 0, threads: int = 0,
          progress: Progress = None) -> LightField:
    """Photograph a synthetic scene as a light field, as `lfsynth` does, and open it.

    Parameters
    ----------
    scene : {"still-life", "lights", "chart", "foliage"}
        The scene.
    folder : path
        Folder of the light field.
    capture : {"planar", "band", "hemisphere"}
        Arrangement of the LF cameras: a grid, rows along an arc, or a dome.
    count : int, optional
        Approximate number of LF cameras.
    size : tuple of int, optional
        Width and height of the LF images in pixels.
    spacing, distance : float, optional
        Distance between neighbouring LF cameras, and from them to the scene, in metres.
    jitter : float
        Largest random change of poses: of positions in multiples of the spacing, of directions in degrees.
    format : {"exr", "png", "png16"}
        File format of the LF images.
    alpha : {"none", "straight", "premultiplied"}
        Alpha of the LF images. "none": the whole scene; otherwise only its surfaces, on a transparent background.
    bayer : bool
        True: write mosaics, as 16-bit PNG.
    noise : float
        Standard deviation of the noise of mosaics at radiance 1.
    distortion, fisheye : sequence of float
        Parameters of OpenCV's lens models (k1, k2, p1, p2, k3, ...) or (k1, k2, k3, k4).
    fov : float
        Parameter of COLMAP's FOV model in radians; 0: none.
    samples : int, optional
        Rays per pixel at edges of the LF images; by default as the scene recommends.
    truth : Path or path, optional
        A camera path, with `unit_m` 1, or its file: the frames that a real lens would film along this path are written
        to `folder`/truth as frame_0001.exr, ...
    truth_samples : int, optional
        Rays per pixel of these frames.
    calibration_only : bool
        True: write no images.
    overwrite : bool
        False: a light field in the folder is an error. True: it is replaced. If this function or `lfsynth` wrote it,
        and its calibration was not changed, those of its LF images that the new one does not have are removed, unless
        `calibration_only` is True.
    seed : int
        Seed of `jitter` and `noise`.
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of LF images that were written, and their total number; then, from 0 again, with those of
        the frames of `truth`. True: a bar for each.

    Returns
    -------
    LightField

    Notes
    -----
    Parameters that are None have values that suit the scene. Its world unit is one metre.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> lf.synth("chart", "chart", count=4, size=(48, 32), samples=1)
    <LightField ...chart: 4 LF images>
    """
    words = _core.SyntheticFieldOptions()
    words.scene = arguments.choice("scene", scene, ("still-life", "lights", "chart", "foliage"))
    words.output = arguments.file_name("folder", folder)
    words.capture = arguments.choice("capture", capture, ("planar", "band", "hemisphere"))
    words.format = arguments.choice("format", format, ("exr", "png", "png16"))
    words.alpha = arguments.choice("alpha", alpha, ("none", "straight", "premultiplied"))
    if count is not None:
        words.count = arguments.whole_within("count", count, 1, 100_000_000)
    if size is not None:
        width, height = arguments.whole_numbers("size", size, 2)
        if not (1 <= width <= 32768 and 1 <= height <= 32768):
            raise UsageError(f"size={size!r}: expected a width and a height from 1 to 32768")
        words.size = (width, height)
    words.spacing = None if spacing is None else arguments.positive("spacing", spacing, 1e6)
    words.distance = None if distance is None else arguments.positive("distance", distance, 1e6)
    words.jitter = arguments.within("jitter", jitter, 0, 1)
    words.noise = arguments.within("noise", noise, 0, 10)
    words.distortion = _lens_parameters("distortion", distortion, 8)
    words.fisheye = _lens_parameters("fisheye", fisheye, 4)
    words.fov = arguments.within("fov", fov, 0, 3.14)
    if sum(map(bool, (words.distortion, words.fisheye, words.fov))) > 1:
        raise UsageError("expected one of distortion, fisheye and fov")
    if samples is not None:
        words.samples = arguments.whole_within("samples", samples, 1, 4096)
    if truth_samples is not None:
        words.truth_samples = arguments.whole_within("truth_samples", truth_samples, 1, 10**6)
    for name, value in (("bayer", bayer), ("calibration_only", calibration_only), ("overwrite", overwrite)):
        setattr(words, name, arguments.flag(name, value))
    words.seed = arguments.seed("seed", seed)
    if isinstance(truth, Path):
        if truth[0].unit_m != 1:
            raise UsageError(f"truth: the path has unit_m={truth[0].unit_m:g}, and synthetic scenes have unit_m=1")
        words.truth_cameras = [camera._core for camera in truth]
        if truth._shutter is not None:
            _, words.truth_instants, words.truth_cameras = truth._shutter
        words.first_truth_frame = truth.first_frame
    file = b"" if truth is None or isinstance(truth, Path) else arguments.file_name("truth", truth)
    with telling(checked(progress), "files") as tell:
        _core.synth(words, file, arguments.thread_count(threads), tell)
    return opening.open(folder)


def _lens_parameters(name: str, values: Sequence[float], most_count: int) -> List[float]:
    parameters = arguments.numbers(name, values, 0, most_count)
    if not all(abs(k) <= 1e6 for k in parameters):
        raise UsageError(f"{name}={values!r}: expected numbers from -1e6 to 1e6")
    return list(parameters)


def _images(count: int) -> str:
    return "1 LF image is" if count == 1 else f"{count} LF images are"


def _checked(field: LightField) -> LightField:
    if not isinstance(field, LightField):
        raise TypeError(f"expected a light field of lf.open(), found {field!r}")
    return field


def _preprocess(field: LightField, path: Union[Path, Camera], frames: Frames, words: _core.PackageWords,
                depths: Optional[Tuple[float, float]], threads: int, progress: Progress,
                options: Dict[str, Any]) -> _Facts:
    cameras = path_in(field, path)
    if depths is not None:
        near, far = arguments.numbers("depths", depths, 2, 2)
        if not 0 < near < far <= sys.float_info.max:
            raise UsageError(f"depths={depths!r}: expected a near depth above 0 and a far depth beyond it")
        words.depths = (near, far)
    film = film_words(options, {})
    with telling(progress, "steps") as tell:
        facts = _facts(_core.preprocess(
            field._core, os.fsencode(field.source), [camera._core for camera in cameras], cameras.fps,
            cameras.first_frame, cameras._shutter, frame_numbers(frames, cameras), film, words,
            arguments.thread_count(threads), tell))
    return facts


def _facts(text: str) -> _Facts:
    facts: _Facts = json.loads(text)
    return facts


def _at_least_1(name: str, value: Optional[int]) -> Optional[int]:
    return None if value is None else arguments.whole_within(name, value, 1, 1_000_000)
