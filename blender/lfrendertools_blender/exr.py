# SPDX-License-Identifier: Apache-2.0
"""Checks OpenEXR files, and removes attributes from them, so that equal pictures are equal files.

Cycles writes the seconds that it rendered into every file (`cycles.*`), and has no option that leaves them out. The
functions read the files that a capture writes: scan lines of one part, compressed with ZIP, 16 lines at a time.
"""
import os
import struct

MAGIC = bytes([0x76, 0x2F, 0x31, 0x01])
ZIP = 3
LINES_OF_CHUNK = 16


class ExrError(ValueError):
    pass


def read_header(data):
    """Returns the attributes as {name: (type, value)}, in bytes, and the position of the first byte behind them."""
    if data[:4] != MAGIC or len(data) < 8 or struct.unpack_from("<I", data, 4)[0] & ~0x400 != 2:
        raise ExrError("no OpenEXR file of scan lines")
    attributes, position = {}, 8
    try:
        while data[position]:
            name_end = data.index(0, position)
            type_end = data.index(0, name_end + 1)
            size, = struct.unpack_from("<I", data, type_end + 1)
            begin = type_end + 5
            attributes[data[position:name_end]] = data[name_end + 1:type_end], data[begin:begin + size]
            position = begin + size
    except (IndexError, ValueError, struct.error):
        raise ExrError("the header is cut off") from None
    return attributes, position + 1


def picture_size(attributes):
    """Returns width and height."""
    if attributes.get(b"compression") != (b"compression", bytes([ZIP])) or b"dataWindow" not in attributes:
        raise ExrError("not compressed with ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes[b"dataWindow"][1])
    return x1 - x0 + 1, y1 - y0 + 1


def chunk_offsets(data, attributes, position):
    """Returns where the chunks of lines begin in the file. Their table stands behind the header."""
    count = -(-picture_size(attributes)[1] // LINES_OF_CHUNK)
    try:
        return struct.unpack_from(f"<{count}Q", data, position)
    except struct.error:
        raise ExrError("the table of chunks is cut off") from None


def without_attributes(data, prefix):
    """Returns the file without the attributes whose names begin with prefix (bytes)."""
    attributes, position = read_header(data)
    offsets = chunk_offsets(data, attributes, position)
    header = data[:8]
    for name, (kind, value) in attributes.items():
        if not name.startswith(prefix):
            header += name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    header += b"\0"
    moved = len(header) - position
    table = struct.pack(f"<{len(offsets)}Q", *(offset + moved for offset in offsets))
    return header + table + data[position + len(table):]


def is_whole(path, size):
    """Returns true if the file has this size in pixels, and ends where its last chunk of lines ends."""
    try:
        with open(path, "rb") as file:
            data = file.read(1 << 16)
            attributes, position = read_header(data)
            if picture_size(attributes) != size:
                return False
            table_end = position + 8 * -(-size[1] // LINES_OF_CHUNK)
            data += file.read(max(table_end - len(data), 0))
            last = max(chunk_offsets(data, attributes, position))
            file.seek(last + 4)
            stored, = struct.unpack("<I", file.read(4))
            return os.fstat(file.fileno()).st_size == last + 8 + stored
    except (FileNotFoundError, ExrError, struct.error):
        return False
