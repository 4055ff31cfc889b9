#!/usr/bin/env python3
"""Bits per pixel of pictures of two levels: fitted systems of maps beside lossless codes.

On a fresh Debian:

    apt-get install --no-install-recommends netpbm jbigkit-bin python3
    cargo build --locked --release
    python3 benches/compression.py            # about ten minutes
    python3 benches/compression.py maple-leaf dragon
    python3 benches/compression.py --pictures leaf.pbm scan.png

Pictures are drawn by `kfrac grow`, black on white, 256 pixels a side, without antialiasing: a pixel is black from half
its darkness on. They are coded as PNG of one bit (`pnmtopng`), as CCITT group 4 (`pnmtotiff`) and as JBIG (`pbmtojbg`, the
arithmetic coder of ITU-T T.82, on which JBIG2 builds), all of them without loss. `kfrac fit` finds maps and disks, whose
numbers are counted with the bits that they need: the code is lossy, and IoU is the share of black pixels that both pictures have.
Headers of files are counted as they are; a table of sizes in bits per pixel, of all pixels of the picture, is printed.
"""

import argparse
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
KFRAC = HERE.parent / "target/release/kfrac"
SIDE = 256
NAMES = [
    "barnsley-fern", "dragon-ifs", "gasket", "hexagon", "koch-ifs", "koch-island-disks", "levy-ifs", "maple-leaf",
    "pentagon", "pound-sign", "snowflake-tiles", "tree-libeskind-hadas", "twindragon-ifs",
]
TOOLS = ["pngtopnm", "ppmtopgm", "pamthreshold", "pamtopnm", "pamfile", "pnmtopng", "pnmtotiff", "pbmtojbg"]

def output(command, data=None):
    return subprocess.run(command, input=data, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True).stdout


def bitmap(png):
    """The picture as a plain map of bits, of which black is the foreground."""
    grey = output(["pngtopnm", "-mix", "-background", "white"], png)
    return output(["pamtopnm"], output(["pamthreshold", "-simple", "-threshold", "0.5"], output(["ppmtopgm"], grey)))


def drawn(name, kfrac):
    options = ["--size", str(SIDE), "--color-by", "none", "--stroke", "black", "--background", "white", "--quiet"]
    return output([kfrac, "grow", name, *options, "--format", "png", "-o", "-"])


def fitted(path, kfrac):
    rule = path.with_suffix(".yaml")
    return json.loads(output([kfrac, "fit", path, "-o", rule, "--json", "--quiet"]))


def row(title, bits, folder, kfrac):
    path = folder / "picture.pbm"
    path.write_bytes(bits)
    width, height = map(int, output(["pamfile", "-size", path]).split())
    coders = [["pnmtopng"], ["pnmtotiff", "-g4"], ["pbmtojbg", "-q"]]
    sizes = [8 * len(output(coder, bits)) / (width * height) for coder in coders]
    fit = fitted(path, kfrac)
    sizes.append(fit["bits_per_pixel"])
    print(f"{title:22}" + "".join(f"{size:10.4f}" for size in sizes) + f"{fit['iou']:8.3f}", flush=True)
    return sizes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=NAMES, help="names in the library")
    parser.add_argument("--pictures", nargs="*", default=[], help="files (PBM, PNG) instead of names")
    parser.add_argument("--kfrac", default=KFRAC)
    arguments = parser.parse_args()
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        sys.exit(f"not installed: {', '.join(missing)}")
    print(f"{'picture':22}{'PNG':>10}{'CCITT G4':>10}{'JBIG':>10}{'fit':>10}{'IoU':>8}")
    with tempfile.TemporaryDirectory() as folder:
        def one(title, bits):
            return row(title, bits, Path(folder), arguments.kfrac)

        if arguments.pictures:
            pictures = [Path(path) for path in arguments.pictures]
            rows = [one(path.stem, read(path)) for path in pictures]
        else:
            rows = [one(name, bitmap(drawn(name, arguments.kfrac))) for name in arguments.names]
    medians = [statistics.median(column) for column in zip(*rows)]
    print(f"{'median':22}" + "".join(f"{size:10.4f}" for size in medians))


def read(path):
    data = path.read_bytes()
    return bitmap(data) if data.startswith(b"\x89PNG") else data


if __name__ == "__main__":
    main()
