# SPDX-License-Identifier: Apache-2.0
"""Writes cameras as other programs export them, and projects points by the formulas of these programs: with numpy,
from their documentation and sources, independently of the library.

A function write_X(folder, views, ...) fills a folder and returns a function project(i, points) -> pixels. Pixel
positions are those of the library: the centre of the upper left pixel is (0.5, 0.5).
"""
import dataclasses
import json

import numpy as np
from PIL import Image


@dataclasses.dataclass
class View:
    name: str  # without extension
    rotation: np.ndarray  # cam_from_world, x right, y down, z forward
    centre: np.ndarray
    size: tuple  # width, height

    def camera_points(self, points):
        return (points - self.centre) @ self.rotation.T

    @property
    def translation(self):
        return -self.rotation @ self.centre


def rotation_about(axis_angle):
    """Returns the matrix that turns about a vector by its length in radians (Rodrigues)."""
    angle = np.linalg.norm(axis_angle)
    x, y, z = axis_angle / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def axis_angle_of(rotation):
    angle = np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1))
    axis = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                     rotation[1, 0] - rotation[0, 1]])
    return axis / (2 * np.sin(angle)) * angle


def random_views(count=4, size=(160, 120), sizes=None, seed=1):
    random = np.random.default_rng(seed)
    return [View(f"view{i}", rotation_about(random.uniform(-0.4, 0.4, 3)), random.uniform(-2, 2, 3),
                 sizes[i] if sizes else size) for i in range(count)]


def points_before(view, count=60, reach=0.42, seed=2):
    """Returns points of the world that a camera with a focal length of about its width sees."""
    random = np.random.default_rng(seed)
    depth = random.uniform(1, 9, (count, 1))
    camera = np.hstack([random.uniform(-reach, reach, (count, 2)) * depth, depth])
    return camera @ view.rotation + view.centre


def write_images(folder, views, extension=".png", rename=lambda name: name):
    folder.mkdir(parents=True, exist_ok=True)
    for number, view in enumerate(views):
        Image.new("RGB", view.size, (40 * number, 90, 60)).save(folder / (rename(view.name) + extension))


def plane(camera):
    return camera[:, :2] / camera[:, 2:]


def brown(p, k1=0, k2=0, k3=0, p1=0, p2=0):
    """Returns distorted positions; p1 belongs to x y in x."""
    x, y = p.T
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2 ** 2 + k3 * r2 ** 3
    return np.stack([x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                     y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)], axis=1)


def angles(camera):
    """Returns the positions of an equidistant fish-eye, and the squares of the angles."""
    r = np.linalg.norm(camera[:, :2], axis=1, keepdims=True)
    theta = np.arctan2(r, camera[:, 2:])
    return camera[:, :2] / r * theta, theta ** 2


# OpenSfM: types.py, geometry/camera_*.h, features.py (normalized_image_coordinates)

def opensfm_lens(camera, model, k):
    if model in ("perspective", "radial", "simple_radial", "brown"):
        return brown(plane(camera), **k)
    uv, s = angles(camera)
    if model in ("fisheye", "fisheye_opencv"):
        return uv * (1 + sum(k.get(f"k{n}", 0) * s ** n for n in range(1, 5)))
    u, v = uv.T
    s = s[:, 0]
    radial = 1 + sum(k.get(f"k{n}", 0) * s ** n for n in range(1, 7))
    p1, p2 = k.get("p1", 0), k.get("p2", 0)
    s0, s1, s2, s3 = (k.get(f"s{n}", 0) for n in range(4))
    return np.stack([u * radial + 2 * p1 * u * v + p2 * (s + 2 * u * u) + s0 * s + s1 * s * s,
                     v * radial + 2 * p2 * u * v + p1 * (s + 2 * v * v) + s2 * s + s3 * s * s], axis=1)


def write_opensfm(folder, views, model="perspective", images="images", focal_px=None, **lens):
    two_focals = model not in ("perspective", "fisheye")
    focal = {"focal_x": 0.9, "focal_y": 0.93, "c_x": 0.01, "c_y": -0.02} if two_focals else {"focal": 0.9}
    if focal_px:
        focal = {"focal": focal_px / max(views[0].size)}
    cameras, shots = {}, {}
    for view in views:
        width, height = view.size
        key = f"v2 maker {width} {height} {model}"
        cameras[key] = {"projection_type": model, "width": width, "height": height, **focal, **lens}
        shots[view.name + ".png"] = {"rotation": axis_angle_of(view.rotation).tolist(),
                                     "translation": view.translation.tolist(), "camera": key,
                                     "orientation": 1, "capture_time": 0.0}
    (folder / "reconstruction.json").write_text(json.dumps(
        [{"cameras": cameras, "shots": shots, "points": {"1": {"coordinates": [0, 0, 1], "color": [1, 2, 3]}}}]))
    write_images(folder / images, views)

    def project(i, points):
        width, height = views[i].size
        xy = opensfm_lens(views[i].camera_points(points), model, lens)
        if two_focals:
            xy = xy * [focal["focal_x"], focal["focal_y"]] + [focal["c_x"], focal["c_y"]]
        else:
            xy = xy * focal["focal"]
        return xy * max(width, height) + [width / 2, height / 2]
    return project


# AliceVision: sfmDataIO/jsonIO.cpp, camera/IntrinsicScaleOffset.cpp, camera/Distortion*.cpp, camera/cameraCommon.hpp.
# Pixel centres are at whole numbers: camera/cameraUndistortImage.hpp, image/Sampler.hpp.

ALICE_LENSES = {
    "none": lambda p, k: p,
    "radialk1": lambda p, k: brown(p, k[0]),
    "radialk3": lambda p, k: brown(p, *k),
    "radialk3pt": lambda p, k: brown(p, *k) / (1 + sum(k)),
    "brown": lambda p, k: brown(p, *k),
}


def alice_lens(p, distortion, k):
    if distortion in ALICE_LENSES:
        return ALICE_LENSES[distortion](p, k)
    r = np.linalg.norm(p, axis=1, keepdims=True)
    if distortion == "fisheye1":
        return p / r * np.arctan(2 * r * np.tan(k[0] / 2)) / k[0]
    theta = np.arctan(r)
    return p / r * (theta + sum(c * theta ** (2 * n + 3) for n, c in enumerate(k)))


OLD_TYPES = {"none": "pinhole", "radialk1": "radial1", "radialk3": "radial3", "brown": "brown",
             "fisheye": "fisheye4", "fisheye1": "fisheye1"}


def texts(numbers):
    """Returns numbers as boost::property_tree writes them: as texts."""
    return [repr(float(x)) for x in numbers]


def alice_pose(rotation, centre):
    return {"rotation": texts(rotation.T.ravel()), "center": texts(centre)}  # column by column


def write_meshroom(folder, views, version=(1, 2, 11), distortion="none", lens=(), name="cameras.sfm", in_rig=False):
    width, height = views[0].size
    sensor_mm, fx, fy, cx, cy = 23.5, 151.0, 148.0, 83.0, 57.5
    entry = {"intrinsicId": "771", "width": str(width), "height": str(height), "sensorWidth": str(sensor_mm),
             "serialNumber": "x", "distortionParams": texts(lens) or ""}
    if version < (1, 2, 8):
        entry["type"] = OLD_TYPES[distortion]
    else:
        entry.update(type="pinhole", distortionType=distortion, undistortionType="none")
    offset = [0, 0] if version < (1, 2, 1) else [width / 2, height / 2]
    entry["principalPoint"] = texts([cx - offset[0], cy - offset[1]])
    if version < (1, 2, 0):
        fy = fx
        entry["pxFocalLength"] = str(fx)
    elif version < (1, 2, 2):
        entry["pxFocalLength"] = texts([fx, fy])
    elif version < (1, 2, 5):
        entry.update(focalLength=repr(fx * sensor_mm / width), pixelRatio=repr(fx / fy))
    elif version < (1, 2, 11):
        entry.update(focalLength=repr(fx * sensor_mm / width), pixelRatio=repr(fy / fx))
    else:
        entry.update(focalLength=repr(fy * sensor_mm / max(width, height)), pixelRatio=repr(fy / fx))

    rig_rotation, rig_centre = rotation_about(np.array([0.1, -0.2, 0.05])), np.array([0.3, -0.1, 0.2])
    listed, poses, sub_poses = [], [], []
    for number, view in enumerate(views):
        listed.append({"viewId": str(1000 + number), "poseId": str(2000 + number), "intrinsicId": "771",
                       "path": f"/gone/capture/images/{view.name}.png", "width": str(width), "height": str(height),
                       "metadata": {"Make": "x"}})
        if in_rig:  # the rig stands at one place; each of its cameras has a pose relative to it
            listed[-1].update(poseId="2000", rigId="5", subPoseId=str(number), isPoseIndependant="false")
            sub_poses.append({"status": "estimated", "pose": alice_pose(
                view.rotation @ rig_rotation.T, rig_rotation @ (view.centre - rig_centre))})
        else:
            poses.append({"poseId": str(2000 + number),
                          "pose": {"transform": alice_pose(view.rotation, view.centre), "locked": "0"}})
    if in_rig:
        poses.append({"poseId": "2000", "pose": {"transform": alice_pose(rig_rotation, rig_centre), "locked": "0"}})
    listed.append({"viewId": "9", "poseId": "9", "intrinsicId": "771", "path": "/gone/capture/images/lost.png"})
    scene = {"version": [str(v) for v in version], "featuresFolders": "", "views": listed, "intrinsics": [entry],
             "poses": poses}
    if in_rig:
        scene["rigs"] = [{"rigId": "5", "subPoses": sub_poses}]
    (folder / name).write_text(json.dumps(scene, indent=4))
    write_images(folder / "images", views)

    def project(i, points):
        xy = alice_lens(plane(views[i].camera_points(points)), distortion, list(lens))
        return xy * [fx, fy] + [cx, cy] + 0.5
    return project


# OpenMVG: cameras/Camera_Pinhole_*.hpp and *_io.hpp, geometry/pose3_io.hpp, sfm/sfm_view_io.hpp.
# Pixel centres are at whole numbers: cameras/Camera_undistort_image.hpp.

MVG_KEYS = {"pinhole_radial_k1": "disto_k1", "pinhole_radial_k3": "disto_k3", "pinhole_brown_t2": "disto_t2",
            "fisheye": "fisheye"}
MVG_LENSES = {"pinhole": "none", "pinhole_radial_k1": "radialk1", "pinhole_radial_k3": "radialk3",
              "pinhole_brown_t2": "brown", "fisheye": "fisheye"}


def write_openmvg(folder, views, model="pinhole", lens=()):
    focal, cx, cy = 150.5, 81.25, 58.75
    intrinsics, listed, extrinsics = [], [], []
    for number, view in enumerate(views):  # one camera for each image; only the first names the model
        data = {"width": view.size[0], "height": view.size[1], "focal_length": focal + number,
                "principal_point": [cx, cy]}
        if model in MVG_KEYS:
            data[MVG_KEYS[model]] = list(lens)
        named = {"polymorphic_id": 2147483649, "polymorphic_name": model} if number == 0 else {"polymorphic_id": 1}
        intrinsics.append({"key": number, "value": {
            **named, "ptr_wrapper": {"id": 2147483660 + number, "data": data}}})
        listed.append({"key": number, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {
            "id": 2147483649 + number, "data": {
                "local_path": "", "filename": view.name + ".png", "width": view.size[0], "height": view.size[1],
                "id_view": number, "id_intrinsic": number, "id_pose": 70 + number}}}})
        extrinsics.append({"key": 70 + number, "value": {"rotation": view.rotation.tolist(),
                                                         "center": view.centre.tolist()}})
    listed.append({"key": 99, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2147483800, "data": {
        "local_path": "", "filename": "lost.png", "width": 1, "height": 1, "id_view": 99,
        "id_intrinsic": 4294967295, "id_pose": 99}}}})
    (folder / "sfm_data.json").write_text(json.dumps({
        "sfm_data_version": "0.3", "root_path": "/gone/images", "views": listed, "intrinsics": intrinsics,
        "extrinsics": extrinsics, "structure": [{"key": 0, "value": {"X": [0, 0, 1], "observations": []}}],
        "control_points": []}, indent=4))
    write_images(folder / "images", views)

    def project(i, points):
        xy = alice_lens(plane(views[i].camera_points(points)), MVG_LENSES[model], list(lens))
        return xy * (focal + i) + [cx, cy] + 0.5
    return project


# Bundler: README, "Output format"

def write_bundler(folder, views, k1=0.0, k2=0.0, name="bundle.out", list_name="list.txt", focal_px=None):
    flip = np.diag([1.0, -1, -1])
    focals = [focal_px or 140.0 + number for number in range(len(views))]
    lines = ["# Bundle file v0.3", f"{len(views) + 1} 1"]
    for number, view in enumerate(views):
        rotation, translation = flip @ view.rotation, flip @ view.translation
        lines += [f"{focals[number]!r} {k1!r} {k2!r}",
                  *(" ".join(texts(row)) for row in rotation), " ".join(texts(translation))]
    lines += ["0 0 0", "0 0 0", "0 0 0", "0 0 0", "0 0 0"]  # an image without a pose
    lines += ["1 2 3", "255 0 0", "1 0 7 10.5 -3.25"]
    (folder / name).write_text("\n".join(lines) + "\n")
    (folder / list_name).write_text("".join(f"./images/{v.name}.png 0 140.5\n" for v in views) + "./images/lost.png\n")
    write_images(folder / "images", views)

    def project(i, points):
        rotation, translation = flip @ views[i].rotation, flip @ views[i].translation
        p = points @ rotation.T + translation
        p = -p[:, :2] / p[:, 2:]
        r2 = (p ** 2).sum(axis=1, keepdims=True)
        x, y = (focals[i] * (1 + k1 * r2 + k2 * r2 ** 2) * p).T
        # The origin is the middle of the image, x points right and y up.
        width, height = views[i].size
        return np.stack([width / 2 + x, height / 2 - y], axis=1)
    return project


# VisualSFM: http://ccwu.me/vsfm/doc.html (NVM), and util.h of Multicore Bundle Adjustment

def quaternion(rotation):
    """Returns w, x, y, z; for rotations by less than half a turn."""
    w = np.sqrt(1 + np.trace(rotation)) / 2
    return [w, (rotation[2, 1] - rotation[1, 2]) / (4 * w), (rotation[0, 2] - rotation[2, 0]) / (4 * w),
            (rotation[1, 0] - rotation[0, 1]) / (4 * w)]


def write_nvm(folder, views, r=0.0, header="NVM_V3", fixed=None):
    lines = [header + (" FixedK " + " ".join(texts([*fixed, r])) if fixed else ""), "", str(len(views))]
    for number, view in enumerate(views):
        turn = view.rotation.ravel() if header.endswith("R9T") else quaternion(view.rotation)
        place = view.translation if header.endswith("R9T") else view.centre
        lines.append(f"images/{view.name}.png\t" + " ".join(texts([140 + number, *turn, *place, r])) + " 0 ")
    lines += ["", "0", "0"]
    (folder / "model.nvm").write_text("\n".join(lines) + "\n")
    write_images(folder / "images", views)

    def project(i, points):
        p = plane(views[i].camera_points(points))
        undistorted = np.linalg.norm(p, axis=1)
        # Solves undistorted = d (1 + r d^2) for d by Newton's iteration.
        d = undistorted.copy()
        for _ in range(60):
            d -= (d * (1 + r * d * d) - undistorted) / (1 + 3 * r * d * d)
        p = p * (d / undistorted)[:, None]
        if fixed:
            fx, cx, fy, cy = fixed
            return p * [fx, fy] + [cx, cy]
        width, height = views[i].size
        return p * (140 + i) + [width / 2, height / 2]
    return project


# 3D Gaussian splatting: utils/camera_utils.py (camera_to_JSON), and ndc2Pix of its rasteriser

def write_splat_cameras(folder, views, focal_px=None):
    focals = [(focal_px or 151.0 + number, focal_px or 148.0 + number) for number in range(len(views))]
    entries = [{"id": number, "img_name": view.name, "width": view.size[0], "height": view.size[1],
                "position": view.centre.tolist(), "rotation": view.rotation.T.tolist(),
                "fx": focals[number][0], "fy": focals[number][1]} for number, view in enumerate(views)]
    (folder / "cameras.json").write_text(json.dumps(entries))
    write_images(folder / "images", views)

    def project(i, points):
        xy = plane(views[i].camera_points(points)) * focals[i]
        width, height = views[i].size
        ndc = xy / [width / 2, height / 2]  # from -1 to 1
        return ((ndc + 1) * [width, height] - 1) * 0.5 + 0.5  # ndc2Pix counts pixel centres by whole numbers
    return project


# MVSNet: README, "File Formats"; pixel centres at half integers: mvsnet/homography_warping.py (get_pixel_grids)

def write_mvsnet(folder, views, scale=1.0, extension=".jpg"):
    k = np.array([[151.0, 0.25, 81.5], [0, 148.0, 58.25], [0, 0, 1]])
    (folder / "cams").mkdir(parents=True)
    for number, view in enumerate(views):
        extrinsic = np.eye(4)
        extrinsic[:3, :3], extrinsic[:3, 3] = view.rotation, view.translation
        intrinsic = np.diag([scale, scale, 1]) @ k
        rows = [" ".join(texts(row)) for row in extrinsic]
        (folder / "cams" / f"{view.name}_cam.txt").write_text("\n".join(
            ["extrinsic", *rows, "", "intrinsic", *(" ".join(texts(row)) for row in intrinsic), "",
             f"{1.5 + number} 0.02 192 {6.5 + number}"]) + "\n")
    write_images(folder / "images", views, extension)

    def project(i, points):
        return (plane(views[i].camera_points(points)) @ k[:2, :2].T) + k[:2, 2]
    return project


# nerfies: camera.py

def write_nerfies(folder, views, scale=1, **lens):
    (folder / "camera").mkdir(parents=True)
    focal, ratio, skew, cx, cy = 151.0, 0.98, 0.5, 81.5, 58.25
    for view in views:
        (folder / "camera" / f"{view.name}.json").write_text(json.dumps({
            "orientation": view.rotation.tolist(), "position": view.centre.tolist(), "focal_length": focal,
            "principal_point": [cx, cy], "skew": skew, "pixel_aspect_ratio": ratio,
            "radial_distortion": [lens.get(key, 0) for key in ("k1", "k2", "k3")],
            "tangential_distortion": [lens.get(key, 0) for key in ("p1", "p2")], "image_size": list(view.size)}))
    (folder / "camera" / "unlisted.json").write_text("{}")
    (folder / "dataset.json").write_text(json.dumps({"count": len(views), "ids": [view.name for view in views]}))
    (folder / "scene.json").write_text(json.dumps({"scale": 0.5, "center": [1, 2, 3], "near": 0.75, "far": 4}))
    write_images(folder / "rgb" / f"{scale}x",
                 [dataclasses.replace(v, size=(v.size[0] // scale, v.size[1] // scale)) for v in views])

    def project(i, points):
        x, y = brown(plane(views[i].camera_points(points)), **lens).T
        return np.stack([focal * x + skew * y + cx, focal * ratio * y + cy], axis=1) / scale
    return project


# NSVF: data/data_utils.py (load_intrinsics, get_uv), data/geometry.py (uv2cam). Pixel centres are at whole numbers.

def write_nsvf(folder, views, matrix=False):
    (folder / "pose").mkdir(parents=True)
    focal, cx, cy = 151.0, 81.5, 58.25
    for number, view in enumerate(views):
        world_from_cam = np.eye(4)
        world_from_cam[:3, :3], world_from_cam[:3, 3] = view.rotation.T, view.centre
        (folder / "pose" / f"{number}.txt").write_text(
            "".join(" ".join(texts(row)) + "\n" for row in world_from_cam))
    k = f"{focal} 0 {cx} 0\n0 {focal} {cy} 0\n0 0 1 0\n0 0 0 1\n" if matrix else f"{focal} {cx} {cy} 0.\n0. 0. 0.\n"
    (folder / "intrinsics.txt").write_text(k)
    write_images(folder / "rgb", views)

    def project(i, points):
        return plane(views[i].camera_points(points)) * focal + [cx, cy] + 0.5
    return project


# TUM's RGB-D benchmark: "File Formats"

def write_tum(folder, views):
    lines, names = ["# timestamp tx ty tz qx qy qz qw"], ["# timestamp filename"]
    for number, view in enumerate(views):
        w, x, y, z = quaternion(view.rotation.T)
        lines.append(f"{1305031449.5 + number} " + " ".join(texts([*view.centre, x, y, z, w])))
        names.append(f"{1305031449.5 + number} rgb/{view.name}.png")
    (folder / "groundtruth.txt").write_text("\n".join(lines) + "\n")
    (folder / "rgb.txt").write_text("\n".join([*names, "1305031999 rgb/lost.png"]) + "\n")
    write_images(folder / "rgb", views)

    def project(i, points):
        width, height = views[i].size
        return plane(views[i].camera_points(points)) * 150 + [width / 2, height / 2]
    return project
