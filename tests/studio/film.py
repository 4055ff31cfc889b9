"""Makes the README's moving picture of frames: python3 film.py FOLDER studio.gif (Pillow)."""

import sys
from pathlib import Path

from PIL import Image

folder, made = sys.argv[1:]
SIZE = (880, 550)
frames = [Image.open(path).convert("RGB").resize(SIZE, Image.LANCZOS) for path in sorted(Path(folder).glob("*.png"))]
# One palette for all, so that what rests is equal from frame to frame.
tiles = Image.new("RGB", (SIZE[0], SIZE[1] * 4))
for place, number in enumerate((0, len(frames) // 3, 2 * len(frames) // 3, len(frames) - 1)):
    tiles.paste(frames[number], (0, place * SIZE[1]))
palette = tiles.quantize(64, method=Image.Quantize.MEDIANCUT)
frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
pauses = [1200] + [380] * (len(frames) - 2) + [1800]
frames[0].save(made, save_all=True, append_images=frames[1:], duration=pauses, loop=0, optimize=True)
