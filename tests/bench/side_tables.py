"""The smaller tables of tables.py: memory a triangle, what branches and regions cost, what skipping saves, the
implicit integrator on a graded mesh, pictures a second, frame times. Each is made from a benchmark's records or by a
program of its own.
"""

import statistics
import subprocess
import sys


def nanoseconds(records):
    return 1e9 * statistics.median(r["time/tri"] for r in records)


def seconds(records):
    scale = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    return statistics.median(r["real_time"] * scale[r["time_unit"]] for r in records)


def parts_of(name):
    return [p for p in name.split("/") if p != "real_time"]


def print_branches(found):
    """branches/<kernel>/<triangles>/<n>: a row a kernel and mesh, a column a number of branches."""
    rows = {}
    for name, records in found.items():
        _, kernel, triangles, branches = parts_of(name)
        rows.setdefault((kernel, int(triangles)), {})[int(branches)] = nanoseconds(records)
    counts = sorted({n for row in rows.values() for n in row})
    print("\n## One step by the number of Maxwell branches, ns a triangle\n")
    print("| kernel, triangles | " + " | ".join(str(n) for n in counts) + " |")
    print("|---" * (len(counts) + 1) + "|")
    for (kernel, triangles), row in sorted(rows.items()):
        cells = [f"{row[n]:.3g}" if n in row else "" for n in counts]
        print(f"| {kernel}, {triangles:,} | " + " | ".join(cells) + " |")


def print_regions(found):
    """regions/<kernel>/<triangles>: two materials; what the assembled form takes, and the element kernel."""
    rows = {}
    for name, records in found.items():
        _, kernel, triangles = parts_of(name)
        rows.setdefault(int(triangles), {})[kernel] = nanoseconds(records)
    print("\n## One step with two materials, ns a triangle\n")
    print("| triangles | csr | element | times |")
    print("|---|---|---|---|")
    for triangles, row in sorted(rows.items()):
        if "csr" in row and "element" in row:
            print(f"| {triangles:,} | {row['csr']:.3g} | {row['element']:.3g} | {row['csr'] / row['element']:.2g} |")


# What, with what is skipped, without: names of rheo_bench_skip's and rheo_bench_render's.
SKIPS = [
    ("constraints that hold identically", "skip/constraints/eliminated", "skip/constraints/solved_for"),
    ("branches of one rate as one", "skip/branches/combined", "skip/branches/both"),
    ("a zero modulus", "skip/zero_modulus/no_branch", "skip/zero_modulus/advanced"),
    ("purely elastic: no relaxation", "skip/relaxation/from_u", "skip/relaxation/combined"),
    ("u once a step", "skip/displacement/once", "skip/displacement/every_sweep"),
    ("energies at outputs only", "skip/energies/never", "skip/energies/every_step"),
    ("norms at outputs only", "skip/norms/never", "skip/norms/every_step"),
    ("a body at rest", "skip/rest/at_rest", "skip/rest/moving"),
    ("at rest under a load", "skip/rest/under_load/at_rest", "skip/rest/under_load/stepped"),
    ("at rest, with a constraint", "skip/rest/constraint/at_rest", "skip/rest/constraint/stepped"),
    ("denormal numbers flushed", "skip/denormals/relaxed", "skip/denormals/relaxed_unflushed"),
    ("no colour shown", "DrawAndReadBackBare/triangles:10000/height:720", "DrawAndReadBack/triangles:10000/height:720"),
    ("upload: nothing moved", "DrawAndReadBackStill/triangles:10000/height:720",
     "DrawAndReadBack/triangles:10000/height:720"),
]


def print_skips(found):
    """With against without, each by the figure it has: ns a triangle and step, us a simulated second, ms a frame."""

    def figure(records):
        units = {"time/tri": ("ns a triangle and step", 1e9), "time/s": ("us a simulated second", 1e6)}
        for counter, (unit, scale) in units.items():
            if counter in records[0]:
                return scale * statistics.median(r[counter] for r in records), unit
        return seconds(records) * 1e3, "ms a frame"

    records_of = {"/".join(parts_of(name)): records for name, records in found.items()}
    print("\n## What is skipped, with against without\n")
    print("| what | skipped | not | times | unit |")
    print("|---|---|---|---|---|")
    for what, skipped, kept in SKIPS:
        if skipped in records_of and kept in records_of:
            (less, unit), (more, _) = figure(records_of[skipped]), figure(records_of[kept])
            print(f"| {what} | {less:.3g} | {more:.3g} | {more / less:.3g} | {unit} |")
    if "skip/denormals/fresh" in records_of and "skip/denormals/relaxed" in records_of:
        fresh, relaxed = records_of["skip/denormals/fresh"], records_of["skip/denormals/relaxed"]
        print(
            f"\nA step before relaxing: {figure(fresh)[0]:.3g} ns a triangle; after {relaxed[0]['relaxed_s']:.2g} s, when "
            f"the largest number left but of u is {relaxed[0]['left']:.1g}: {figure(relaxed)[0]:.3g}."
        )


def print_graded(found):
    """integrate/implicit_graded/<steps a frame> against RK4 at its limit on the same mesh."""
    rk4 = next((records for name, records in found.items() if "rk4_graded" in name), None)
    if rk4 is None:
        return
    run = statistics.median(r["run_seconds"] for r in rk4)
    frame = rk4[0]["frame/limit"]
    print(f"\n## A graded mesh: a frame is {frame:.3g} stable RK4 steps long\n")
    print("| implicit, steps a frame | seconds | error | RK4, seconds (from 1,000 steps) | times |")
    print("|---|---|---|---|---|")
    for name, records in sorted(found.items()):
        if "implicit_graded" in name:
            took = seconds(records)
            print(f"| {parts_of(name)[-1]} | {took:.3g} | {records[0]['error']:.2g} | {run:.3g} | {run / took:.3g} |")


def print_pictures(found):
    """Pictures a second by way of encoding: rheo_bench_render's Sequence..."""
    names = {
        "SequenceByStbDefaults": "stb_image_write's defaults",
        "SequenceOnOneThread": "rheo, in the drawing thread",
        "SequenceWithEncoders<1>": "rheo, one encoding thread",
        "SequenceWithEncoders<2>": "rheo, two encoding threads",
        "SequenceWithoutFiles": "drawing and reading back alone",
    }
    rows, subjects = {}, []
    for name, records in found.items():
        way, *arguments = parts_of(name)
        subject = dict(a.split(":") for a in arguments if ":" in a)
        subject = (int(subject.get("disk", 0)), int(subject["triangles"]))
        subjects.append(subject)
        rows.setdefault(way, {})[subject] = 1.0 / seconds(records)
    subjects = sorted(set(subjects))
    print("\n## Pictures a second, 1280 x 720\n")
    print("| | " + " | ".join(f"{'disk' if disk else 'beam'}, {n:,} triangles" for disk, n in subjects) + " |")
    print("|---" * (len(subjects) + 1) + "|")
    for way, title in names.items():
        if way in rows:
            cells = [f"{rows[way][s]:.0f}" if s in rows[way] else "" for s in subjects]
            print(f"| {title} | " + " | ".join(cells) + " |")


def print_memory(program, sizes):
    """The table of rheo_bench_memory, which prints Markdown itself."""
    command = [str(program), *sizes]
    print(f"running {' '.join(command)}", file=sys.stderr)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    print("\n## Memory\n\n" + done.stdout)


def print_frames(program, options):
    """The table of rheo_bench_frame_time, which prints Markdown itself."""
    command = [str(program), *options]
    print(f"running {' '.join(command)}", file=sys.stderr)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode == 77:
        print("\n## Frame times\n\nNothing to draw with: install libosmesa6.")
        return
    done.check_returncode()
    print("\n## Frame times\n\n" + done.stdout)
