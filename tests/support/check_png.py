#!/usr/bin/env python3
"""check_png.py WIDTH HEIGHT FILE...: whether each is a whole 8-bit RGB PNG of that size that shows something.

Reads the chunks itself and shares no code with lodbench. Prints a line for each that is not; exit status
1 then.
"""
import struct
import sys
import zlib


def fault_of(data, width, height):
    """What is wrong, or None."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return "no PNG signature"
    at, pixels, last = 8, b"", b""
    while at < len(data):
        if at + 12 > len(data):
            return f"{len(data) - at} bytes after the last chunk"
        length, = struct.unpack(">I", data[at:at + 4])
        last, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        if data[at + 8 + length:at + 12 + length] != struct.pack(">I", zlib.crc32(last + body)):
            return f"the checksum of chunk {last} is wrong"
        if last == b"IHDR" and struct.unpack(">IIBBBBB", body) != (width, height, 8, 2, 0, 0, 0):
            return f"IHDR is {struct.unpack('>IIBBBBB', body)}"
        if last == b"IDAT":
            pixels += body
        at += 12 + length
    if last != b"IEND":
        return "no end chunk"
    rows = zlib.decompress(pixels)
    if len(rows) != height * (1 + 3 * width):
        return f"{len(rows)} bytes of rows"
    # Filtered rows of one colour are alike from the second on, and zero after their first pixel.
    stride = 1 + 3 * width
    if height > 2 and len({rows[i:i + stride] for i in range(stride, len(rows), stride)}) == 1:
        return "all rows are alike"
    return None


def main():
    bad = False
    for path in sys.argv[3:]:
        with open(path, "rb") as file:
            fault = fault_of(file.read(), int(sys.argv[1]), int(sys.argv[2]))
        if fault:
            print(f"{path}: {fault}")
            bad = True
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
