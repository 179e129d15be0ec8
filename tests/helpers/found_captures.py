# SPDX-License-Identifier: Apache-2.0
"""Writes one small light field in the folders that people have: names of other systems, images elsewhere, several
calibrations side by side, texts of other programs. Each function gets the calibration (a parsed transforms.json whose
images are in `source`) and a folder to fill, and returns LIGHTFIELD, if it is not this folder.
"""
import json
import pathlib
import shutil
import struct
import unicodedata

import numpy as np
from PIL import Image

import write_formats

KEYS = ("fl_x", "fl_y", "cx", "cy", "w", "h")
WINDOWS_HOME = "C:\\Users\\Jo\\scans\\"


def images_into(source, folder, rename=None):
    """Copies the images; rename(index, name) is the new name, relative to the folder."""
    for index, file in enumerate(sorted((source / "images").iterdir())):
        target = folder / (rename(index, file.name) if rename else file.name)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)


def transforms(field, folder, name=None, keys=KEYS, file="transforms.json", frames=None):
    """Writes a transforms.json whose frames have the names name(index, old name)."""
    frames = [dict(frame) for frame in (frames if frames is not None else field["frames"])]
    for index, frame in enumerate(frames):
        frame.pop("lf_translation", None)
        if name:
            frame["file_path"] = name(index, pathlib.Path(frame["file_path"]).name)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / file).write_text(json.dumps({**{key: field[key] for key in keys}, "frames": frames}))


def angle(field):
    return {**field, "camera_angle_x": 2 * np.arctan(field["w"] / 2 / field["fl_x"])}


def windows_relative(field, source, folder):
    images_into(source, folder / "images")
    transforms(field, folder / "calibration", lambda index, name: "..\\images\\" + name)
    return folder / "calibration"


def windows_absolute(field, source, folder):
    images_into(source, folder / "images")
    transforms(field, folder, lambda index, name: WINDOWS_HOME + "images\\" + name)


def windows_beside(field, source, folder):
    """The images are beside the folder of the calibration."""
    images_into(source, folder / "images")
    transforms(field, folder / "calibration", lambda index, name: WINDOWS_HOME + "images\\" + name)
    return folder / "calibration"


def byte_order_mark(field, source, folder):
    write_formats.colmap_text(field, source, folder)
    for file in (folder / "sparse/0").glob("*.txt"):
        file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())


def commas(field, source, folder):
    write_formats.colmap_text(field, source, folder)
    for file in (folder / "sparse/0").glob("*.txt"):
        lines = file.read_text().splitlines()
        file.write_text("\n".join(line if line.startswith("#") else line.replace(" ", ", ") for line in lines) + "\n")


def model_in_text(field, source, folder):
    write_formats.colmap_text(field, source, folder)
    shutil.move(folder / "sparse/0", folder / "text")
    (folder / "sparse/0").mkdir(parents=True)
    shutil.move(folder / "text", folder / "sparse/0/text")


def model_in_dense(field, source, folder):
    write_formats.colmap_text(field, source, folder / "dense/0")
    shutil.move(folder / "dense/0/sparse/0", folder / "model")
    shutil.rmtree(folder / "dense/0/sparse")
    shutil.move(folder / "model", folder / "dense/0/sparse")


def nfd_files(field, source, folder, form="NFD", stated="NFC"):
    """COLMAP's names are in one normal form of Unicode, the files in the other, as macOS writes them."""
    write_formats.colmap_text(field, source, folder)
    images = folder / "sparse/0/images.txt"
    text = images.read_text()
    for file in sorted((folder / "images").iterdir()):
        text = text.replace(" " + file.name, " " + unicodedata.normalize(stated, "K\u00fcche " + file.name))
        file.rename(file.with_name(unicodedata.normalize(form, "K\u00fcche " + file.name)))
    images.write_text(text)


def nfc_files(field, source, folder):
    nfd_files(field, source, folder, form="NFC", stated="NFD")


def dates_before_names(field, source, folder):
    images_into(source, folder / "photos", lambda index, name: "2021-05-04 12.30.01 " + name)
    transforms(field, folder, lambda index, name: "images/" + name)


def angle_alone_moved(field, source, folder):
    """Blender's form, which lacks the size of the images, and a folder of images with another name."""
    images_into(source, folder / "photos")
    transforms(angle(field), folder, lambda index, name: "./images/" + name[:-4], keys=["camera_angle_x"])


def splits(field, source, folder):
    """A data set in three parts, of which two share poses."""
    parts = {"train": field["frames"][::2], "val": field["frames"][1::4], "test": field["frames"][1::2]}
    for part, frames in parts.items():
        transforms(angle(field), folder, lambda index, name, part=part: f"./{part}/" + name[:-4],
                   keys=["camera_angle_x"], file=f"transforms_{part}.json", frames=frames)
        for frame in frames:
            (folder / part).mkdir(exist_ok=True)
            shutil.copy(source / frame["file_path"], folder / part)


def llff_smaller(field, source, folder):
    """Only the smaller copies are left; their folder is not called images."""
    write_formats.llff(field, source, folder)
    shutil.move(folder / "images", folder / "images_2")
    for file in (folder / "images_2").iterdir():
        image = Image.open(file)
        image.resize((image.width // 2, image.height // 2), Image.Resampling.BOX).save(file)


def half_copied_model(field, source, folder):
    write_formats.llff(field, source, folder)
    (folder / "sparse/0").mkdir(parents=True)
    (folder / "sparse/0/cameras.bin").write_bytes(bytes(8))


def matrix_in_frames(field, source, folder):
    images_into(source, folder / "images")
    matrix = [[field["fl_x"], 0, field["cx"]], [0, field["fl_y"], field["cy"]], [0, 0, 1]]
    transforms(field, folder, keys=("w", "h"),
               frames=[{**frame, "intrinsic_matrix": matrix} for frame in field["frames"]])


def not_a_number(field, source, folder):
    images_into(source, folder / "images")
    transforms(field, folder, frames=[{**frame, "sharpness": float("nan")} for frame in field["frames"]])


def grid_names(field, source, folder, name):
    """Names the images of a square grid name(row, column, place), with rows from above and columns from the left."""
    side = round(len(field["frames"]) ** 0.5)
    matrices = [np.array(frame["transform_matrix"]) for frame in field["frames"]]
    right, up = matrices[0][:3, 0], matrices[0][:3, 1]
    places = sorted(range(side * side), key=lambda i: (round(-up @ matrices[i][:3, 3], 6),
                                                       round(right @ matrices[i][:3, 3], 6)))
    folder.mkdir(parents=True)
    for place, index in enumerate(places):
        shutil.copy(source / field["frames"][index]["file_path"], folder / name(place // side, place % side, place))


def row_and_column(field, source, folder):
    grid_names(field, source, folder, lambda row, column, place: f"{row:02d}_{column:02d}.png")


def marked_places(field, source, folder):
    grid_names(field, source, folder, lambda row, column, place: f"view_r{row}_c{column}.png")


def places_with_hyphens(field, source, folder):
    grid_names(field, source, folder, lambda row, column, place: f"lf-{row}-{column}.png")


def places_in_brackets(field, source, folder):
    grid_names(field, source, folder, lambda row, column, place: f"Cam({row},{column}).png")


def numbered_grid(field, source, folder):
    grid_names(field, source, folder, lambda row, column, place: f"input_Cam{place:03d}.png")


# Linear sRGB of linear Display P3 (both have the white point D65), and the colorants of Display P3 for D50.
SRGB_OF_P3 = np.array([[1.2249402, -0.2249402, 0], [-0.0420570, 1.0420570, 0], [-0.0196376, -0.0786361, 1.0982736]])
P3_COLORANTS = {b"rXYZ": (0.5151, 0.2412, -0.0011), b"gXYZ": (0.2920, 0.6922, 0.0419),
                b"bXYZ": (0.1571, 0.0666, 0.7841)}


def linear(values):
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def encoded(light):
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def display_p3_profile():
    """Returns an ICC profile of version 2 with the primaries of Display P3 and the curve of sRGB."""
    def xyz(values):
        return b"XYZ \0\0\0\0" + struct.pack(">3i", *(round(value * 65536) for value in values))
    name = b"Display P3\0"
    curve = (linear(np.arange(1024) / 1023) * 65535).round().astype(">u2")
    curve = b"curv\0\0\0\0" + struct.pack(">I", len(curve)) + curve.tobytes()
    tags = {b"desc": b"desc\0\0\0\0" + struct.pack(">I", len(name)) + name + bytes(78),
            b"cprt": b"text\0\0\0\0none\0", b"wtpt": xyz((0.9642, 1, 0.8249)),
            **{tag: xyz(values) for tag, values in P3_COLORANTS.items()},
            b"rTRC": curve, b"gTRC": curve, b"bTRC": curve}
    table, body = b"", b""
    begin = 128 + 4 + 12 * len(tags)
    for tag, data in tags.items():
        data += bytes(-len(data) % 4)
        table += tag + struct.pack(">2I", begin + len(body), len(data))
        body += data
    header = struct.pack(">I4sI4s4s4s12x4s4sIIIQI3i", begin + len(body), b"none", 0x02100000, b"mntr", b"RGB ", b"XYZ ",
                         b"acsp", b"none", 0, 0, 0, 0, 0, 63190, 65536, 54061)
    return header.ljust(128, b"\0") + struct.pack(">I", len(tags)) + table + body


def display_p3(field, source, folder, suffix):
    """Writes the images as a phone does: the same colours by the numbers of Display P3."""
    (folder / "images").mkdir(parents=True)
    for file in sorted((source / "images").iterdir()):
        light = linear(np.asarray(Image.open(file).convert("RGB")) / 255)
        numbers = encoded(light @ np.linalg.inv(SRGB_OF_P3).T)
        Image.fromarray((255 * numbers).round().astype(np.uint8)).save(
            (folder / "images" / file.name).with_suffix(suffix), icc_profile=display_p3_profile(), quality=97,
            subsampling=0)
    transforms(field, folder, lambda index, name: "images/" + name.replace(".png", suffix))


# Folders that every program opens as they are. All of them show the same light field.
OPEN_AS_THEY_ARE = [
    windows_relative, windows_absolute, windows_beside, byte_order_mark, commas, model_in_text, model_in_dense,
    nfd_files, nfc_files, dates_before_names, angle_alone_moved, splits, llff_smaller, half_copied_model,
    matrix_in_frames, not_a_number]
# Folders whose names lack the pitch; lfimport prints the call that writes a calibration.
PRINT_A_CALL = [row_and_column, numbered_grid, marked_places, places_with_hyphens, places_in_brackets]
