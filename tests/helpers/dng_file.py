# SPDX-License-Identifier: Apache-2.0
"""Writes DNG files for tests: a TIFF with one uncompressed strip of 16-bit pixels."""
import struct

SHORT, LONG, RATIONAL, SRATIONAL, BYTE, TEXT = 3, 4, 5, 10, 1, 2


def dng(mosaic, pattern="RGGB", black=0, white=65535, neutral=None, orientation=1) -> bytes:
    """Returns the bytes of a file. mosaic: uint16 [height][width]; neutral: AsShotNeutral, together with a colour
    matrix (camera = CIE XYZ); None: neither of them."""
    height, width = mosaic.shape
    pixels = mosaic.astype("<u2").tobytes()
    tags = {
        254: (LONG, [0]), 256: (LONG, [width]), 257: (LONG, [height]), 258: (SHORT, [16]),
        259: (SHORT, [1]), 262: (SHORT, [32803]), 271: (TEXT, b"lf\0"), 272: (TEXT, b"test\0"),
        273: (LONG, None), 274: (SHORT, [orientation]), 277: (SHORT, [1]), 278: (LONG, [height]),
        279: (LONG, [len(pixels)]), 284: (SHORT, [1]), 33421: (SHORT, [2, 2]),
        33422: (BYTE, bytes("RGB".index(letter) for letter in pattern)),
        50706: (BYTE, bytes([1, 4, 0, 0])), 50708: (TEXT, b"lf test\0"),
        50714: (LONG, [black]), 50717: (LONG, [white])}
    if neutral:
        tags[50728] = (RATIONAL, [(round(1000 * x), 1000) for x in neutral])
        tags[50721] = (SRATIONAL, [(int(i % 4 == 0), 1) for i in range(9)])
        tags[50778] = (SHORT, [21])

    def packed(kind, values):
        if kind in (BYTE, TEXT):
            return len(values), values
        if kind in (RATIONAL, SRATIONAL):
            form = "<II" if kind == RATIONAL else "<ii"
            return len(values), b"".join(struct.pack(form, *value) for value in values)
        return len(values), struct.pack(f"<{len(values)}{'H' if kind == SHORT else 'I'}", *values)

    values_at = 8 + 2 + 12 * len(tags) + 4
    long_values = {tag: packed(*content)[1] for tag, content in tags.items() if content[1]}
    long_values = {tag: value + b"\0" * (len(value) % 2) for tag, value in long_values.items()
                   if len(value) > 4}
    pixels_at = values_at + sum(map(len, long_values.values()))
    tags[273] = (LONG, [pixels_at])
    directory = struct.pack("<H", len(tags))
    for tag in sorted(tags):
        count, value = packed(*tags[tag])
        if tag in long_values:
            place = values_at + sum(len(v) for t, v in long_values.items() if t < tag)
            value = struct.pack("<I", place)
        directory += struct.pack("<HHI", tag, tags[tag][0], count) + value.ljust(4, b"\0")
    values = b"".join(long_values[tag] for tag in sorted(long_values))
    return b"II*\0" + struct.pack("<I", 8) + directory + b"\0" * 4 + values + pixels
