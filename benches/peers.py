#!/usr/bin/env python3
"""kfrac beside Context Free, flam3, numba, l-system-fractals, trimesh, POV-Ray and Mitsuba: ratios of time, peak memory, and
the targets.

On a fresh Debian:

    apt-get install --no-install-recommends contextfree flam3-utils python3
    cargo build --locked --release
    python3 benches/peers.py            # about ten minutes; cfdg takes up to 7 GB of memory
    python3 benches/peers.py --quick    # a minute; small cases only
    python3 benches/peers.py --films    # films only; half a minute
    python3 -m pip install numba        # to compare the chaos game with numba, and boxes with numpy
    python3 -m pip install trimesh scipy    # to compare voxels with trimesh
    cargo install --locked l-system-fractals     # for the Koch curve as an L-system
    apt-get install --no-install-recommends povray    # for the sponge in space; 4 GB of memory
    python3 -m pip install mitsuba      # for a deeper sponge in space

Whole commands run alternately, and their medians are compared: on a machine with other load only the
ratios are meaningful. Outputs are files in a temporary folder (set by TMPDIR; a folder in memory
excludes the disk). Peak memory is that of the process, but at least this script's own, some 15 MiB.

The inputs are in benches/peers: the same curves for cfdg, and rules that the library does not have.
Colours are switched off: both cfdg and kfrac draw black bars. kfrac and flam3 run on one thread, then on
two. Programs other than cfdg are skipped if they are not installed (numba: for the Python that runs
this script). The times of numba and numpy are those of their loops, the time of kfrac that of the whole command.
The times of films are processor times of whole commands, divided by the number of frames: kfrac writes pixels to a
pipe, and its peers write their files.
"""

import argparse
import importlib.util
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PLAIN = ["--color-by", "none", "--stroke", "black", "--quiet"]

# Title, rule, steps, cfdg's source and depth, format, number of runs, smallest ratio of times, largest
# MiB, and whether --quick includes the case.
BESIDE = [
    ("Koch 4^10 to PNG 1024²", "koch", 10, "koch", 10, "png", 5, 40, 32, True),
    ("Koch 4^10 to SVG", "koch", 10, "koch", 10, "svg", 5, 150, 32, True),
    ("Koch 4^12 to PNG 1024²", "koch", 12, "koch", 12, "png", 1, 75, 64, False),
    ("dragon 2^23 to PNG 1024²", "dragon", 23, "dragon", 23, "png", 1, 75, 64, False),
    ("tree 2^23 to PNG 1024²", HERE / "peers/tree.yaml", 22, "tree", 22, "png", 1, 75, 64, False),
]

# Threads, and the smallest ratio of times to flam3.
RANDOM = [(1, 10), (2, 20)]

# Title, rule, numba's program, points, and the smallest ratio of times to numba, on one thread.
NUMBA = [
    ("fern", "barnsley-fern-four", "fern", 20_000_000, 5),
    ("Menger sponge", "menger", "menger", 20_000_000, 6),
    ("fern", "barnsley-fern-four", "fern", 100 * 1024**2, 5),
]

# Points in space, and the smallest ratio of times to numpy, on one thread.
BOXES = (2_000_000, 50)

# Steps of the sponge that trimesh divides into voxels of its cubes' size; and the largest number of seconds in which
# all voxels down to 3^-12 are counted.
VOXELS = (3, 0.5)

# Smallest ratio of times to l-system-fractals.
STRINGS = 18

# Levels of the sponge, and the smallest ratio of times to POV-Ray.
SPONGE = (5, 8)

# Level of the sponge, of which two levels are instanced by hand in Mitsuba, and the smallest ratio of times.
DEEP_SPONGE = (7, 3)

# Sets in space, sides of pictures, the largest number of seconds on one thread; and the smallest ratio on two.
SPACE = [
    (name, side, seconds)
    for side, seconds in [(1024, 0.8), (2048, 2)]
    for name in ["menger", "icosahedron-flake", "solid-tetrahedron"]
]
TWO_THREADS = 1.8

# Film of 640 x 480 pixels: title, kfrac's rule and options, number of frames, largest number of processor milliseconds a
# frame; name of the peer, and the smallest ratio of times.
FILMS = [
    (
        "family, tree of 2^17 branches",
        [HERE / "peers/tree.yaml", "--set", "angle=10..60", "--steps", 16, *PLAIN],
        60, 12, "cfdg, a process a frame", 15,
    ),
    (
        "family, tree of 2^13 branches",
        [HERE / "peers/tree.yaml", "--set", "angle=10..60", "--steps", 12, *PLAIN],
        60, 3, "cfdg, a process a frame", None,
    ),
    ("growth to Koch 4^8", ["koch", "--steps", "7..8", *PLAIN], 60, 3, "cfdg --animate", None),
    (
        "family of ferns, 1 M points",
        [HERE / "peers/fern.yaml", "--set", "bend=0.04..0.12", "--method", "chaos", "--points", "1M", "--quiet"],
        60, 6, "flam3-animate", 10,
    ),
    (
        "zoom to 1e1000",
        ["koch", "--zoom", "1..1e1000", "--at", "0.(1)", "--detail", "0.5", "--quiet"],
        300, 30, None, None,
    ),
]  # fmt: skip

# Formats of a film of a tree, without a target.
ENCODERS = ["y4m", "gif", "png"]

# Title, command, and largest number of milliseconds.
ALONE = [
    ("info koch --steps 2000 --json", ["info", "koch", "--steps", "2000", "--json"], 20),
    ("info snow-crystal --steps 2000 --json", ["info", "snow-crystal", "--steps", "2000", "--json"], 20),
    ("list", ["list"], 10),
    ("Menger step 60 to USDA", ["grow", "menger", "--steps", "60", "--format", "usda", "-o", "-", "--quiet"], 20),
    (
        "3·10⁹ blades of grass to PNG 1024²",
        ["grow", "autumn", "--set", "meadow=15", "--size", "1024", "--format", "png", "-o", "-", "--quiet"],
        2000,
    ),
]


def run(command, source=None, environment=None):
    """Returns the seconds and MiB of a command, which must succeed."""
    start = time.perf_counter()
    process = subprocess.Popen(
        [str(part) for part in command],
        stdin=source,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=environment and {**os.environ, **environment},
    )
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {errors.decode(errors='replace').strip()}")
    return seconds, usage.ru_maxrss / 1024


def in_turn(commands, runs):
    """Runs commands alternately; returns the median of seconds and the largest MiB of each."""
    results = [[run(command) for command in commands] for _ in range(runs)]
    return [
        (statistics.median(seconds for seconds, _ in column), max(mib for _, mib in column))
        for column in zip(*results)
    ]


def processor_time(command, source=None, environment=None):
    """Returns the seconds of processor time of a command, which must succeed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    _, memory = run(command, source, environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, memory


def row(name, *cells):
    print(f"{name:<40}" + "".join(f"{cell:>14}" for cell in cells), flush=True)


def verdict(is_met):
    return "met" if is_met else "missed"


def beside(kfrac, folder, quick):
    row("beside cfdg", "kfrac", "cfdg", "ratio", "target", "", "memory", "target", "")
    for name, rule, steps, source, depth, kind, runs, ratio, mib, is_small in BESIDE:
        if quick and not is_small:
            continue
        ours = [kfrac, "grow", rule, "--steps", steps, "-o", folder / f"ours.{kind}", *PLAIN]
        theirs = ["cfdg", "-q", "-s", 1024, "-m", 100_000_000, "-x", 0.0001, "-v", "AAAAAA"]
        theirs += ["-D", f"depth={depth}", *(["-V"] if kind == "svg" else [])]
        theirs += [HERE / f"peers/{source}.cfdg", folder / f"theirs.{kind}"]
        (seconds, memory), (peer, _) = in_turn([ours, theirs], 1 if quick else runs)
        row(
            name,
            f"{seconds:.3f} s",
            f"{peer:.2f} s",
            f"{peer / seconds:.1f} x",
            f"{ratio} x",
            verdict(peer / seconds >= ratio),
            f"{memory:.0f} MiB",
            f"{mib} MiB",
            verdict(memory <= mib),
        )


def beside_flam3(kfrac, folder, quick):
    """Compares the fern by random iteration with flam3: 100 points a pixel of 1024², as flam3 draws."""
    print()
    row("beside flam3", "kfrac", "flam3", "ratio", "target", "", "memory")
    for threads, ratio in RANDOM:
        ours, theirs = [], []
        for _ in range(1 if quick else 3):
            command = [kfrac, "grow", "barnsley-fern-four", "--method", "chaos", "--quiet"]
            command += ["--points", 100 * 1024**2, "--size", "1024x1024", "--threads", threads]
            ours.append(run([*command, "-o", folder / "ours.png"]))
            with open(HERE / "peers/fern.flame") as flame:
                settings = {"nthreads": str(threads), "out": str(folder / "theirs.png")}
                theirs.append(run(["flam3-render"], flame, settings))
        seconds, peer = (statistics.median(time for time, _ in each) for each in (ours, theirs))
        row(
            f"fern, 105 M points, {threads} thread{'s' if threads > 1 else ''}",
            f"{seconds:.3f} s",
            f"{peer:.2f} s",
            f"{peer / seconds:.1f} x",
            f"{ratio} x",
            verdict(peer / seconds >= ratio),
            f"{max(memory for _, memory in ours):.0f} MiB",
        )


def beside_numba(kfrac, folder, quick):
    """Compares random iteration, of the plane and of space, with the textbook loops compiled by numba."""
    print()
    row("beside numba", "kfrac", "numba", "ratio", "target", "")
    for name, rule, program, points, ratio in NUMBA[: 2 if quick else None]:
        ours, theirs = [], []
        for _ in range(1 if quick else 3):
            command = [kfrac, "grow", rule, "--method", "chaos", "--quiet"]
            command += ["--points", points, "--size", "1024x1024", "--threads", 1]
            ours.append(run([*command, "-o", folder / "ours.png"])[0])
            peer = [sys.executable, HERE / f"peers/{program}.py", str(points)]
            theirs.append(float(subprocess.run(peer, check=True, capture_output=True).stdout))
        seconds, peer = statistics.median(ours), statistics.median(theirs)
        row(
            f"{name}, {points / 1e6:.0f} M points, 1 thread",
            f"{seconds:.3f} s",
            f"{peer:.2f} s",
            f"{peer / seconds:.1f} x",
            f"{ratio} x",
            verdict(peer / seconds >= ratio),
        )


def beside_numpy(kfrac, folder, quick):
    """Compares boxes of points in space, measured from a file, with the rows that numpy finds distinct."""
    print()
    row("beside numpy", "kfrac", "numpy", "ratio", "target", "")
    points, ratio = BOXES
    peer = [sys.executable, HERE / "peers/boxes.py"]
    file = folder / "points.ply"
    subprocess.run([*peer, "--write", str(points), file], check=True)
    ours, theirs = [], []
    for _ in range(1 if quick else 3):
        command = [kfrac, "dim", file, "--grids", 1, "--orders", 0, "--threads", 1]
        ours.append(run(command)[0])
        counted = subprocess.run([*peer, file], check=True, capture_output=True)
        theirs.append(float(counted.stdout))
    seconds, peer = statistics.median(ours), statistics.median(theirs)
    row(
        f"cubes of nine sizes, {points / 1e6:.0f} M points",
        f"{seconds:.3f} s",
        f"{peer:.2f} s",
        f"{peer / seconds:.1f} x",
        f"{ratio} x",
        verdict(peer / seconds >= ratio),
    )


def beside_trimesh(kfrac, folder, quick):
    """Compares exact counts of the voxels of a limit set with the voxels of a mesh of one approximant."""
    steps, most = (2, VOXELS[1]) if quick else VOXELS
    print()
    row("beside trimesh", "kfrac", "target", "", "trimesh", "memory", "its memory")
    mesh = folder / "sponge.stl"
    run([kfrac, "grow", "menger", "--steps", steps, "--mesh", "shell", "-o", mesh, "--quiet"])
    counted = [kfrac, "dim", "menger", "--orders", 0, "--grids", 1, "--threads", 1]
    theirs = [sys.executable, HERE / "peers/voxels.py", mesh, 3**steps]
    (seconds, memory), (peer, its) = in_turn([counted, theirs], 1 if quick else 3)
    row(
        f"Menger to 3^-12; to 3^-{steps}",
        f"{seconds:.3f} s",
        f"{most} s",
        verdict(seconds <= most),
        f"{peer:.2f} s",
        f"{memory:.0f} MiB",
        f"{its:.0f} MiB",
    )


def beside_strings(kfrac, folder, quick):
    """Compares the Koch curve as an L-system, to SVG, with a program that writes the word."""
    print()
    row("beside l-system-fractals", "kfrac", "theirs", "ratio", "target", "", "memory")
    system = json.loads((HERE / "peers/koch.json").read_text())
    system["filename"] = str(folder / "theirs.svg")
    (folder / "koch.json").write_text(json.dumps(system))
    ours = [kfrac, "grow", "koch-lsystem", "--steps", 10, "-o", folder / "ours.svg", *PLAIN]
    theirs = ["l-system-fractals", folder / "koch.json"]
    (seconds, memory), (peer, _) = in_turn([ours, theirs], 1 if quick else 5)
    row(
        "Koch 4^10 as an L-system to SVG",
        f"{seconds:.3f} s",
        f"{peer:.2f} s",
        f"{peer / seconds:.1f} x",
        f"{STRINGS} x",
        verdict(peer / seconds >= STRINGS),
        f"{memory:.0f} MiB",
    )


def beside_sponge(kfrac, folder, peer, theirs, levels, ratio):
    """Compares a step of the Menger sponge, as a picture, with a peer's command, on one thread."""
    print()
    row(f"beside {peer}", "kfrac", peer, "ratio", "target", "", "memory", "its memory")
    ours = [kfrac, "grow", "menger", "--steps", levels, "--threads", 1, "-o", folder / "ours.png", "--quiet"]
    (seconds, memory), (others, its) = in_turn([ours, theirs], 1)
    row(
        f"Menger level {levels} to PNG 1024²",
        f"{seconds:.3f} s",
        f"{others:.2f} s",
        f"{others / seconds:.1f} x",
        f"{ratio} x",
        verdict(others / seconds >= ratio),
        f"{memory:.0f} MiB",
        f"{its:.0f} MiB",
    )


def beside_pov(kfrac, folder, quick):
    """Compares the sponge with nested unions of cubes in POV-Ray."""
    levels, ratio = (4, SPONGE[1]) if quick else SPONGE
    theirs = ["povray", "+W1024", "+H1024", "+WT1", "-D", "-GA", f"Declare=Level={levels}"]
    theirs += [f"+I{HERE / 'peers/menger.pov'}", f"+O{folder / 'theirs.png'}"]
    beside_sponge(kfrac, folder, "POV-Ray", theirs, levels, ratio)


def beside_mitsuba(kfrac, folder, quick):
    """Compares a deep sponge with instances of a mesh in Mitsuba."""
    levels, ratio = (5, DEEP_SPONGE[1]) if quick else DEEP_SPONGE
    theirs = [sys.executable, HERE / "peers/mitsuba_sponge.py", levels, folder / "theirs.png"]
    beside_sponge(kfrac, folder, "Mitsuba", theirs, levels, ratio)


def film_of(peer, name, folder, quick):
    """Returns a command that makes a film with a peer, its environment, and its number of frames."""
    draw = ["cfdg", "-q", "-w", 640, "-h", 480, "-m", 100_000_000, "-x", 0.0001, "-v", "AAAAAA"]
    if peer == "cfdg --animate":
        frames = 5 if quick else 30
        command = [*draw, "-D", "depth=8", "--animate", frames, HERE / "peers/koch.cfdg", folder / "theirs.mov"]
        return [(command, None)], frames
    if peer == "flam3-animate":
        frames = 5 if quick else 30
        flame = (HERE / "peers/fern.flame").read_text()
        # As many points as kfrac draws, in one sample of time.
        for old, new in [
            ('size="1024 1024"', 'size="640 480" passes="1" temporal_samples="1"'),
            ('quality="100"', f'quality="{1e6 / (640 * 480)}"'),
            ('scale="95"', 'scale="45"'),
        ]:
            flame = flame.replace(old, new)
        bent = flame.replace("-0.04 0.04", "-0.12 0.12")
        times = [it.replace("<flame", f'<flame time="{time}"', 1) for time, it in [(0, flame), (frames, bent)]]
        (folder / "film.flame").write_text(f"<flames>{times[0]}{times[1]}</flames>")
        settings = {"in": str(folder / "film.flame"), "prefix": str(folder / "theirs"), "nthreads": "1"}
        settings |= {"begin": "0", "end": str(frames - 1)}
        return [(["flam3-animate"], settings)], frames
    depth = 16 if "2^17" in name else 12
    angles = [10, 60] if quick else [10, 20, 30, 40, 50, 60]
    commands = [
        ([*draw, "-D", f"depth={depth}", "-D", f"angle={angle}", HERE / "peers/tree.cfdg", folder / "theirs.png"], None)
        for angle in angles
    ]
    return commands, len(angles)


def films(kfrac, folder, quick):
    """Measures the processor time of frames on one thread, without an encoder, beside programs that draw such films."""
    print()
    row("films, CPU a frame", "kfrac", "target", "", "peer", "ratio", "target", "", "memory", "its memory")
    animate = lambda options, frames: [
        kfrac, "animate", *options, "--frames", frames, "--size", "640x480", "--threads", 1,
    ]  # fmt: skip
    for name, options, frames, most, peer, ratio in FILMS:
        frames = frames // 4 if quick else frames
        seconds, memory = processor_time([*animate(options, frames), "-o", "-"])
        ours = 1000 * seconds / frames
        cells = [f"{ours:.1f} ms", f"{most} ms", verdict(ours <= most)]
        if peer is not None and shutil.which(peer.split()[0].rstrip(",")) is not None:
            commands, count = film_of(peer, name, folder, quick)
            measured = [processor_time(command, None, settings) for command, settings in commands]
            theirs = 1000 * sum(seconds for seconds, _ in measured) / count
            cells += [f"{theirs:.0f} ms", f"{theirs / ours:.1f} x"]
            cells += ["", ""] if ratio is None else [f"{ratio} x", verdict(theirs / ours >= ratio)]
            cells += [f"{memory:.0f} MiB", f"{max(memory for _, memory in measured):.0f} MiB"]
        else:
            cells += ["", "", "", "", f"{memory:.0f} MiB"]
        row(name, *cells)
    _, options, *_ = FILMS[1]
    frames = 15 if quick else 60
    for kind in ENCODERS:
        seconds, memory = processor_time([*animate(options, frames), "-o", folder / f"ours.{kind}"])
        row(f"tree of 2^13 branches to .{kind}", f"{1000 * seconds / frames:.1f} ms", *[""] * 6, f"{memory:.0f} MiB")


def in_space(kfrac, folder, quick):
    """Measures pictures in space to the pixel, on one thread and on two."""
    print()
    row("pictures in space", "1 thread", "target", "", "2 threads", "target", "", "memory", "target", "")
    for name, side, most in SPACE:
        command = lambda threads: [
            kfrac, "grow", name, "--size", side, "--threads", threads,
            "-o", folder / "ours.png", "--quiet",
        ]  # fmt: skip
        (one, memory), (two, _) = in_turn([command(1), command(2)], 1 if quick else 5)
        row(
            f"{name} to PNG {side}²",
            f"{one:.2f} s",
            f"{most} s",
            verdict(one <= most),
            f"{one / two:.2f} x",
            f"{TWO_THREADS} x",
            verdict(one / two >= TWO_THREADS),
            f"{memory:.0f} MiB",
            "64 MiB",
            verdict(memory <= 64),
        )


def streamed(kfrac, folder, quick):
    """Measures segments a second to a file, and that memory does not grow with the steps."""
    steps, fewer = (22, 18) if quick else (26, 22)
    command = lambda steps: [
        kfrac, "grow", "dragon", "--steps", steps, "--max-elements", 2**steps,
        "-o", folder / "ours.svg", *PLAIN,
    ]  # fmt: skip
    [(seconds, memory), (_, before)] = in_turn([command(steps), command(fewer)], 1 if quick else 3)
    rate = 2**steps / seconds / 1e6
    print()
    row("kfrac alone", "time", "", "rate", "target", "", "memory")
    row(
        f"dragon 2^{steps} to SVG",
        f"{seconds:.2f} s",
        "",
        f"{rate:.1f} M/s",
        "25 M/s",
        verdict(rate >= 25),
        f"{memory:.1f} MiB",
    )
    row(f"dragon 2^{fewer} to SVG", "", "", "", "", "", f"{before:.1f} MiB")


def alone(kfrac, quick):
    for name, command, most in ALONE:
        [(seconds, memory)] = in_turn([[kfrac, *command]], 5 if quick else 20)
        milliseconds = 1000 * seconds
        cells = [f"{milliseconds:.1f} ms", "", "", f"{most} ms", verdict(milliseconds <= most)]
        row(name, *cells, f"{memory:.1f} MiB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small fractals, few runs")
    parser.add_argument("--films", action="store_true", help="films only")
    target = os.environ.get("CARGO_TARGET_DIR", HERE.parent / "target")
    parser.add_argument("--kfrac", default=Path(target) / "release/kfrac", help="the program")
    arguments = parser.parse_args()
    kfrac = Path(arguments.kfrac).resolve()
    if not kfrac.is_file():
        sys.exit(f"there is no {kfrac}: run cargo build --locked --release")
    if shutil.which("cfdg") is None:
        sys.exit("there is no cfdg: run apt-get install contextfree")
    with tempfile.TemporaryDirectory() as folder:
        if arguments.films:
            return films(kfrac, Path(folder), arguments.quick)
        beside(kfrac, Path(folder), arguments.quick)
        if shutil.which("flam3-render") is not None:
            beside_flam3(kfrac, Path(folder), arguments.quick)
        if importlib.util.find_spec("numba") is not None:
            beside_numba(kfrac, Path(folder), arguments.quick)
        if importlib.util.find_spec("numpy") is not None:
            beside_numpy(kfrac, Path(folder), arguments.quick)
        if importlib.util.find_spec("trimesh") is not None:
            beside_trimesh(kfrac, Path(folder), arguments.quick)
        if shutil.which("l-system-fractals") is not None:
            beside_strings(kfrac, Path(folder), arguments.quick)
        if shutil.which("povray") is not None:
            beside_pov(kfrac, Path(folder), arguments.quick)
        if importlib.util.find_spec("mitsuba") is not None:
            beside_mitsuba(kfrac, Path(folder), arguments.quick)
        films(kfrac, Path(folder), arguments.quick)
        in_space(kfrac, Path(folder), arguments.quick)
        streamed(kfrac, Path(folder), arguments.quick)
        alone(kfrac, arguments.quick)


if __name__ == "__main__":
    main()
