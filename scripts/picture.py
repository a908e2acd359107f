#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""Draws meshes side by side, flat shaded, as a PNG: the picture in README.md.

    scripts/picture.py MESH.ply... -o PICTURE.png [--turn DEGREES] [--width PIXELS]

Reads PLY (ascii or binary little endian, plain or .gz; positions first, then triangles) and needs
nothing but Python's standard library. All meshes are drawn at the scale of the first.
"""
import argparse
import array
import gzip
import math
import struct
import zlib

SAMPLES = 2  # a side of each pixel
SIZES = {"float": "f", "float32": "f", "double": "d", "float64": "d"}


def read_ply(path):
    """The vertices and the triangles, as lists of triples."""
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        counts, kinds, form = {}, [], ""
        element = ""
        for line in iter(file.readline, b"end_header\n"):
            words = line.decode().split()
            if words[0] == "format":
                form = words[1]
            elif words[0] == "element":
                element = words[1]
                counts[element] = int(words[2])
            elif words[0] == "property" and element == "vertex":
                kinds.append(SIZES[words[1]])
        if form == "ascii":
            vertices = [tuple(map(float, file.readline().split()[:3]))
                        for _ in range(counts["vertex"])]
            faces = [tuple(map(int, file.readline().split()[1:4])) for _ in range(counts["face"])]
            return vertices, faces
        if form != "binary_little_endian":
            raise SystemExit(f"picture.py: {path}: cannot read format {form}")
        record = struct.Struct("<" + "".join(kinds))
        data = file.read(record.size * counts["vertex"])
        vertices = [at[:3] for at in record.iter_unpack(data)]
        face = struct.Struct("<B3i")
        return vertices, [at[1:] for at in face.iter_unpack(file.read(face.size * counts["face"]))]


def turned(vertices, degrees):
    """Seen from the front, turned about the vertical axis and a little from above."""
    a, b = math.radians(degrees), math.radians(12)
    ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
    points = []
    for x, y, z in vertices:
        x, z = ca * x + sa * z, ca * z - sa * x
        points.append((x, cb * y - sb * z, cb * z + sb * y))
    return points


def unit(v):
    length = math.sqrt(sum(c * c for c in v)) or 1.0
    return [c / length for c in v]


LIGHT, FILL = unit((-0.5, 0.7, 0.8)), unit((0.8, 0.1, 0.3))


def shade(a, b, c):
    """The grey of a triangle, the same for all of it: facets are to be seen."""
    u = [q - p for p, q in zip(a, b)]
    v = [q - p for p, q in zip(a, c)]
    n = unit((u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))
    main = max(0.0, sum(p * q for p, q in zip(n, LIGHT)))
    fill = max(0.0, sum(p * q for p, q in zip(n, FILL)))
    return min(235, int(38 + 165 * main + 45 * fill))


class Canvas:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.depth = array.array("d", [-math.inf]) * (width * height)
        self.grey = bytearray(b"\xff") * (width * height)

    def triangle(self, a, b, c, grey):
        """Corners are (x, y, depth) in pixels; what is nearer (greater depth) covers."""
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0:
            return
        x0, x1 = math.ceil(min(a[0], b[0], c[0])), math.floor(max(a[0], b[0], c[0]))
        y0, y1 = math.ceil(min(a[1], b[1], c[1])), math.floor(max(a[1], b[1], c[1]))
        for y in range(max(0, y0), min(self.height - 1, y1) + 1):
            for x in range(max(0, x0), min(self.width - 1, x1) + 1):
                v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
                w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
                if v < 0 or w < 0 or v + w > 1:
                    continue
                depth = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
                at = y * self.width + x
                if depth > self.depth[at]:
                    self.depth[at] = depth
                    self.grey[at] = grey

    def rows(self):
        """Rows of pixels, each the mean of its samples."""
        n = SAMPLES
        for y in range(0, self.height, n):
            lines = [self.grey[(y + i) * self.width:(y + i + 1) * self.width] for i in range(n)]
            yield bytes(sum(sum(line[x:x + n]) for line in lines) // (n * n)
                        for x in range(0, self.width, n))


def draw(points, faces, scale, middle, width, height):
    canvas = Canvas(width * SAMPLES, height * SAMPLES)
    put = [((x - middle[0]) * scale + canvas.width / 2, canvas.height / 2 - (y - middle[1]) * scale,
            z) for x, y, z in points]
    for i, j, k in faces:
        canvas.triangle(put[i], put[j], put[k], shade(points[i], points[j], points[k]))
    return list(canvas.rows())


def write_png(path, rows):
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    # Each row as differences to the pixel on the left (filter 1), which compress better.
    packed = b"".join(
        b"\1" + bytes((at - left) % 256 for at, left in zip(row, b"\0" + row)) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(packed, 9)))
        file.write(chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH.ply")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--turn", type=float, default=0, help="degrees about the vertical axis")
    parser.add_argument("--width", type=int, default=1000, help="of the picture, in pixels")
    options = parser.parse_args()
    width = options.width // len(options.meshes) // 2 * 2
    frame = None
    panels = []
    for path in options.meshes:
        vertices, faces = read_ply(path)
        points = turned(vertices, options.turn)
        if frame is None:
            low = [min(p[i] for p in points) for i in range(2)]
            high = [max(p[i] for p in points) for i in range(2)]
            scale = 0.94 * width / (high[0] - low[0])
            height = int(scale * (high[1] - low[1]) / 0.94)
            frame = scale * SAMPLES, [(p + q) / 2 for p, q in zip(low, high)], width, height
        panels.append(draw(points, faces, *frame))
    write_png(options.output, [b"".join(parts) for parts in zip(*panels)])


if __name__ == "__main__":
    main()
