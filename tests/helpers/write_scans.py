# SPDX-License-Identifier: Apache-2.0
"""Writes cameras as programs for scanning and data sets of captures do, like write_exports.py: with numpy, from the
documentation of these programs, independently of the library.
"""
import json
import xml.etree.ElementTree as xml

import numpy as np

from write_exports import angles, axis_angle_of, brown, plane, quaternion, rotation_about, texts, write_images

OPENGL = np.diag([1.0, -1, -1])  # x right, y up, z backwards


def joined(numbers):
    return " ".join(texts(numbers))


def matrix_of(rotation, place):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation, place
    return result


# Metashape: Professional Edition, User Manual, appendix "Camera models", and Agisoft's answers in its forum about
# slaves of rigs

def metashape_pixels(camera, size, lens, fisheye):
    p = angles(camera)[0] if fisheye else plane(camera)
    x, y = p.T
    c = {key: lens.get(key, 0) for key in ("cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2")}
    r2 = x * x + y * y
    radial = 1 + c["k1"] * r2 + c["k2"] * r2 ** 2 + c["k3"] * r2 ** 3 + c["k4"] * r2 ** 4
    xd = x * radial + c["p1"] * (r2 + 2 * x * x) + 2 * c["p2"] * x * y
    yd = y * radial + c["p2"] * (r2 + 2 * y * y) + 2 * c["p1"] * x * y
    f = lens["f"]
    return np.stack([size[0] / 2 + c["cx"] + xd * f + xd * c["b1"] + yd * c["b2"], size[1] / 2 + c["cy"] + yd * f],
                    axis=1)


def add_resolution(parent, size):
    xml.SubElement(parent, "resolution", width=str(size[0]), height=str(size[1]))


def add_transform(parent, rotation, translation, scale):
    transform = xml.SubElement(parent, "transform")
    xml.SubElement(transform, "rotation").text = joined(rotation.ravel())
    xml.SubElement(transform, "translation").text = joined(translation)
    xml.SubElement(transform, "scale").text = repr(float(scale))


def write_metashape(folder, views, lens=None, fisheye=False, rig=False, placed_by="chunk", extension="",
                    focal_px=None):
    """With `rig`, every second camera is the slave of the one before, by a sensor of its own."""
    lens = {"f": focal_px} if focal_px else {"f": 151.0, "cx": 2.5, "cy": -1.25, **(lens or {})}
    turn, shift, scale = rotation_about(np.array([0.4, -0.9, 0.3])), np.array([3.0, -2, 7]), 2.5
    if placed_by is None:
        turn, shift, scale = np.eye(3), np.zeros(3), 1
    document = xml.Element("document", version="2.0.0")
    chunk = xml.SubElement(document, "chunk", label="Chunk 1", enabled="true")
    sensors = xml.SubElement(chunk, "sensors", next_id="9")
    components = xml.SubElement(chunk, "components", next_id="1", active_id="0")
    cameras = xml.SubElement(chunk, "cameras", next_id="99", next_group_id="1")
    group = xml.SubElement(cameras, "group", id="0", label="left", type="folder")
    type_name = "equidistant_fisheye" if fisheye else "frame"

    def add_sensor(number, view, **attributes):
        sensor = xml.SubElement(sensors, "sensor", id=str(number), label="unknown", type=type_name, **attributes)
        add_resolution(sensor, view.size)
        xml.SubElement(sensor, "property", name="pixel_width", value="0.004")
        for kind, values in (("initial", {"f": 99.0}), ("adjusted", lens)):
            calibration = xml.SubElement(sensor, "calibration", {"type": type_name, "class": kind})
            add_resolution(calibration, view.size)
            for key, value in values.items():
                xml.SubElement(calibration, key).text = repr(float(value))
        return sensor

    def chunk_from_cam(view):
        return matrix_of(turn.T @ view.rotation.T, turn.T @ (view.centre - shift) / scale)

    add_sensor(0, views[0])
    for number, view in enumerate(views):
        is_slave = rig and number % 2 == 1
        camera = xml.SubElement(group if number == len(views) - 1 else cameras, "camera", id=str(number),
                                label=view.name + extension, sensor_id=str(number if is_slave else 0))
        if is_slave:
            offset = np.linalg.inv(chunk_from_cam(views[number - 1])) @ chunk_from_cam(view)
            sensor = add_sensor(number, view, master_id="0")
            xml.SubElement(sensor, "rotation").text = joined(offset[:3, :3].ravel())
            xml.SubElement(sensor, "location").text = joined(offset[:3, 3])
            camera.set("master_id", str(number - 1))
        else:
            camera.set("component_id", "0")
            xml.SubElement(camera, "transform").text = joined(chunk_from_cam(view).ravel())
    xml.SubElement(cameras, "camera", id="50", sensor_id="0", label="not aligned")
    off = xml.SubElement(cameras, "camera", id="51", sensor_id="0", component_id="0", label="off", enabled="false")
    xml.SubElement(off, "transform").text = joined(np.eye(4).ravel())
    component = xml.SubElement(components, "component", id="0", label="Component 1")
    if placed_by:
        add_transform(chunk if placed_by == "chunk" else component, turn, shift, scale)
    xml.SubElement(chunk, "reference").text = 'LOCAL_CS["Local Coordinates (m)",UNIT["metre",1]]'
    xml.ElementTree(document).write(folder / "cameras.xml", xml_declaration=True, encoding="UTF-8")
    write_images(folder / "images", views)
    return lambda i, points: metashape_pixels(views[i].camera_points(points), views[i].size, lens, fisheye)


# RealityCapture and RealityScan: "On the Coordinate Systems Employed in the Import, Estimation, and Export of Camera
# Geometry by RealityScan", and the knowledge base, "Registration export and camera orientations"

REALITY_LENS = {"f": 34.0, "px": 0.012, "py": -0.02}


def reality_lens(focal_px, size):
    return {"f": 36 * focal_px / max(size), "px": 0, "py": 0} if focal_px else REALITY_LENS


def reality_pixels(camera, size, k, lens=None):
    x, y = plane(camera).T
    k1, k2, k3, k4, t1, t2 = (k.get(key, 0) for key in ("k1", "k2", "k3", "k4", "t1", "t2"))
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2 ** 2 + k3 * r2 ** 3 + k4 * r2 ** 4
    xd = x * radial + t1 * (r2 + 2 * x * x) + 2 * t2 * x * y
    yd = y * radial + t2 * (r2 + 2 * y * y) + 2 * t1 * x * y
    side, lens = max(size), lens or REALITY_LENS
    return np.stack([size[0] / 2 + side * (lens["px"] + lens["f"] / 36 * xd),
                     size[1] / 2 + side * (lens["py"] + lens["f"] / 36 * yd)], axis=1)


def reality_matrix(yaw_deg, pitch_deg, roll_deg):
    """Returns cam_from_world, as the makers write it for the angles of x = roll, y = pitch and z = yaw."""
    x, y, z = np.radians([roll_deg, pitch_deg, yaw_deg])
    cx, cy, cz, sx, sy, sz = np.cos(x), np.cos(y), np.cos(z), np.sin(x), np.sin(y), np.sin(z)
    return np.array([[cx * cz + sx * sy * sz, -cx * sz + cz * sx * sy, -cy * sx],
                     [-cy * sz, -cy * cz, -sy],
                     [cx * sy * sz - cz * sx, cx * cz * sy + sx * sz, -cx * cy]])


def reality_angles(rotation):
    """Returns yaw, pitch and roll in degrees, the inverse of reality_matrix()."""
    return np.degrees([np.arctan2(-rotation[1, 0], -rotation[1, 1]), np.arcsin(-rotation[1, 2]),
                       np.arctan2(-rotation[0, 2], -rotation[2, 2])])


def write_reality_csv(folder, views, yaw="heading", focal_px=None, **k):
    keys = ["k1", "k2", "k3", "k4", "t1", "t2"]
    rows = [f"#name,x,y,alt,{yaw},pitch,roll,f,px,py," + ",".join(keys)]
    for view in views:
        rows.append(",".join([view.name + ".png", *texts([
            *view.centre, *reality_angles(view.rotation), *reality_lens(focal_px, view.size).values(),
            *(k.get(key, 0) for key in keys)])]))
    (folder / "scan.csv").write_text("\n".join(rows) + "\n")
    write_images(folder / "images", views)
    return lambda i, points: reality_pixels(
        (points - views[i].centre) @ reality_matrix(*reality_angles(views[i].rotation)).T, views[i].size, k,
        reality_lens(focal_px, views[i].size))


def write_reality_opencv(folder, views, **k):
    """Writes the CSV form for OpenCV, whose k3 comes after the tangential coefficients, which are t2 and t1."""
    rows = ["#name,tx,ty,tz,R00,R01,R02,R10,R11,R12,R20,R21,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,k3,k4"]
    for view in views:
        side = max(view.size)
        rows.append(",".join([view.name + ".png", *texts([
            *view.translation, *view.rotation.ravel(), REALITY_LENS["f"] / 36 * side,
            view.size[0] / 2 + side * REALITY_LENS["px"], view.size[1] / 2 + side * REALITY_LENS["py"],
            *(k.get(key, 0) for key in ("k1", "k2", "t2", "t1", "k3", "k4"))])]))
    (folder / "scan.csv").write_text("\n".join(rows) + "\n")
    write_images(folder, views)
    return lambda i, points: reality_pixels(views[i].camera_points(points), views[i].size, k)


def write_reality_xmp(folder, views, model="brown3", as_elements=False, focal_px=None, **k):
    write_images(folder / "images", views)
    for view in views:
        lens = reality_lens(focal_px, view.size)
        lists = {"Rotation": joined(view.rotation.ravel()), "Position": joined(view.centre),
                 "DistortionCoeficients": joined([k.get(key, 0) for key in ("k1", "k2", "k3", "k4", "t1", "t2")])}
        values = {"Version": "3", "PosePrior": "initial", "Coordinates": "absolute", "DistortionModel": model,
                  "FocalLength35mm": repr(lens["f"]), "Skew": "0", "AspectRatio": "1",
                  "PrincipalPointU": repr(lens["px"]), "PrincipalPointV": repr(lens["py"]),
                  "CalibrationPrior": "initial", "InTexturing": "1"}
        if as_elements:
            lists.update(values)
            values = {}
        attributes = " ".join(f'xcr:{key}="{value}"' for key, value in values.items())
        elements = "\n".join(f"      <xcr:{key}>{value}</xcr:{key}>" for key, value in lists.items())
        (folder / "images" / f"{view.name}.xmp").write_text(f"""<x:xmpmeta xmlns:x="adobe:ns:meta/">
  <rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
    <rdf:Description xmlns:xcr="http://www.capturingreality.com/ns/xcr/1.1#" {attributes}>
{elements}
    </rdf:Description>
  </rdf:RDF>
</x:xmpmeta>
""")
    return lambda i, points: reality_pixels(views[i].camera_points(points), views[i].size, k,
                                            reality_lens(focal_px, views[i].size))


# Record3D: its page "Record3D .r3d file format", and ARKit: ARCamera.transform, ARCamera.intrinsics

def write_record3d(folder, views, images="rgbd", each=True, name="metadata"):
    width, height = views[0].size
    k = np.array([[151.0, 0, 81.5], [0, 148.0, 58.25], [0, 0, 1]])
    poses, coefficients = [], []
    for number, view in enumerate(views):
        w, x, y, z = quaternion(OPENGL @ view.rotation)  # camera from world; the conjugate is world from camera
        poses.append([-x, -y, -z, w, *view.centre])
        coefficients.append([k[0, 0] + number, k[1, 1] + number, k[0, 2], k[1, 2]])
    data = {"w": width, "h": height, "dw": width // 4, "dh": height // 4, "fps": 30, "K": k.T.ravel().tolist(),
            "poses": poses, "frameTimestamps": [n / 30 for n in range(len(views))]}
    if each:
        data["perFrameIntrinsicCoeffs"] = coefficients
    (folder / name).write_text(json.dumps(data))
    write_images(folder / images, views, ".jpg")

    def project(i, points):
        return plane(views[i].camera_points(points)) * (k[[0, 1], [0, 1]] + (i if each else 0)) + k[:2, 2]
    return project


# Polycam: github.com/PolyCam/polyform, README and the scripts that convert to other forms

def write_polycam(folder, views, kind="corrected_"):
    cameras = folder / "keyframes" / f"{kind}cameras"
    cameras.mkdir(parents=True)
    for number, view in enumerate(views):
        pose = matrix_of(view.rotation.T @ OPENGL, view.centre)
        (cameras / f"{view.name}.json").write_text(json.dumps({
            "fx": 151.0 + number, "fy": 148.0 + number, "cx": 81.5, "cy": 58.25, "width": view.size[0],
            "height": view.size[1], "blur_score": 90.1, "neighbors": [1], "timestamp": number,
            **{f"t_{row}{column}": pose[row, column] for row in range(3) for column in range(4)}}))
    write_images(folder / "keyframes" / f"{kind}images", views, ".jpg")
    return lambda i, points: plane(views[i].camera_points(points)) * [151.0 + i, 148.0 + i] + [81.5, 58.25]


# Google: github.com/augmentedperception/spaces_dataset and .../deepview_video_dataset, README and camera classes

def write_google_models(folder, views, fisheye=False):
    entries = []
    for number, view in enumerate(views):
        entry = {"width": float(view.size[0]), "height": float(view.size[1]), "focal_length": 151.0 + number,
                 "principal_point": [81.5, 58.25], "position": view.centre.tolist(),
                 "orientation": axis_angle_of(view.rotation).tolist()}
        if fisheye:
            entry.update(name=view.name, projection_type="fisheye", radial_distortion=[0.06, -0.012, 0.0])
        else:
            entry.update(relative_path=f"images/{view.name}.JPG", pixel_aspect_ratio=0.98)
        entries.append(entry)
    (folder / "models.json").write_text(json.dumps(entries if fisheye else [entries[:2], entries[2:]]))
    write_images(folder / "images", views, ".JPG")

    def project(i, points):
        camera = views[i].camera_points(points)
        if not fisheye:
            return plane(camera) * [151.0 + i, (151.0 + i) * 0.98] + [81.5, 58.25]
        theta, s = angles(camera)
        return theta * (1 + 0.06 * s - 0.012 * s * s) * (151.0 + i) + [81.5, 58.25]
    return project


# kapture: github.com/naver/kapture, kapture_format.adoc; the models are those of COLMAP

KAPTURE_LENSES = {
    "PINHOLE": (),
    "OPENCV": ("k1", "k2", "p1", "p2"),
}


def write_kapture(folder, views, model="OPENCV", rig=False, **k):
    """With `rig`, the sensors of all views stand in one rig, which is in another one."""
    sensors = folder / "sensors"
    sensors.mkdir()
    head = "# kapture format: 1.1\n"
    size = views[0].size
    lens = ", ".join(texts([151, 148, 81.5, 58.25, *(k.get(key, 0) for key in KAPTURE_LENSES[model])]))
    listed, records, trajectories, rigs = [], [], [], []
    car = matrix_of(rotation_about(np.array([0.3, 0.2, -0.4])), [1, -2, 0.5])
    roof = matrix_of(rotation_about(np.array([-0.2, 0.6, 0.1])), [0.1, 0, 2])

    def pose_text(pose):
        return ", ".join(texts([*quaternion(pose[:3, :3]), *pose[:3, 3]]))

    for number, view in enumerate(views):
        sensor = f"cam{number}" if rig else "phone"
        if rig or number == 0:
            listed.append(f"{sensor}, name, camera, {model}, {size[0]}, {size[1]}, {lens}")
        pose = matrix_of(view.rotation, view.translation)
        records.append(f"{0 if rig else number:04}, {sensor}, {view.name}.png")
        if rig:
            rigs.append(f"roof, {sensor}, {pose_text(pose @ np.linalg.inv(roof @ car))}")
        else:
            trajectories.append(f"{number}, {sensor}, {pose_text(pose)}")
    if rig:
        rigs.append(f"car, roof, {pose_text(roof)}")
        trajectories.append(f"0, car, {pose_text(car)}")
    for name, lines in (("sensors", listed), ("records_camera", records), ("trajectories", trajectories),
                        ("rigs", rigs)):
        if lines:
            (sensors / f"{name}.txt").write_text(head + "# fields\n" + "\n".join(lines) + "\n")
    write_images(sensors / "records_data", views)

    def project(i, points):
        return brown(plane(views[i].camera_points(points)), **k) * [151, 148] + [81.5, 58.25]
    return project
