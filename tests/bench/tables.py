#!/usr/bin/env python3
"""Runs the benchmark programs and prints, as Markdown, the tables that README shows; draws run time against error.

    python3 tests/bench/tables.py [--build build/release] [--repetitions 5] [--out out/tables]
                                  [--max-triangles 1000000] [--budget 240]
                                  [--scenes beam,beam_fine] [--refined 1000,10000] [--threads N]
                                  [--only steps,memory,branches,skips,graded,pictures,frames,integrators]

A step of the kernels against the baseline and, where it was built, the peer; bytes and flops of a step against
what the machine was measured to do; memory a triangle; steps of several branches and materials; what skipping saves;
the implicit integrator on a graded mesh; pictures a second; frame times; the integrators by `rheo bench` on some
shipped scenes and on the paper's beam, refined and jittered, lumped, pulled for 1 of 2 s; what each takes to reach
1e-3, 1e-5 and 1e-9. Medians of interleaved repetitions, with their spread. The machine should do nothing else
meanwhile: the load at the start is printed.
"""

import argparse
import json
import os
import pathlib
import platform
import random
import statistics
import subprocess
import sys

import side_tables

TOP = pathlib.Path(__file__).resolve().parents[2]


def machine():
    model = platform.processor() or platform.machine()
    cache = ""
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
        size = pathlib.Path("/sys/devices/system/cpu/cpu0/cache/index3/size").read_text().strip()
        cache = f", last-level cache {size}"
    except OSError:
        pass
    load = os.getloadavg()[0]
    return f"{model}, {os.cpu_count()} processors{cache}; load at the start {load:.2f}"


def run_benchmark(program, pattern, arguments):
    """Name -> list of the benchmark's records, one a repetition."""
    command = [
        str(program),
        f"--benchmark_filter={pattern}",
        f"--benchmark_repetitions={arguments.repetitions}",
        "--benchmark_enable_random_interleaving=true",
        f"--benchmark_min_time={arguments.min_time}",
        "--benchmark_format=json",
    ]
    print(f"running {' '.join(command)}", file=sys.stderr)
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    found = {}
    for record in json.loads(done.stdout)["benchmarks"]:
        if record.get("run_type") == "iteration" and not record.get("error_occurred"):
            found.setdefault(record["run_name"], []).append(record)
    return found


def median_and_spread(values):
    middle = statistics.median(values)
    return middle, (max(values) - min(values)) / middle if middle else 0.0


def nanoseconds(records):
    return median_and_spread([1e9 * r["time/tri"] for r in records])


TABLES = ["steps", "memory", "branches", "skips", "graded", "pictures", "frames", "integrators"]


SMALL_SIZES = "100|200|400|900"  # where what does not grow with the mesh counts in start-up


def size_name(triangles):
    if triangles < 1000:
        return str(triangles)
    if triangles >= 1000000:
        return f"{triangles // 1000000}M"
    return f"{triangles // 1000}k"


def by_kernel(found):
    """kernel -> triangles -> records; names are like step/edge/1000/real_time."""
    table = {}
    for name, records in found.items():
        parts = [p for p in name.split("/") if p != "real_time"]
        table.setdefault("/".join(parts[:-1]), {})[int(parts[-1])] = records
    return table


NAMES = {
    "step/csr": "textbook RK4, two Eigen products an evaluation (baseline)",
    "peer/rk4": "SUNDIALS ARKODE, classic RK4, fixed step",
    "peer/dormand_prince": "SUNDIALS ARKODE, Dormand-Prince, 1e-6 (6 evaluations a step)",
    "step/assembled_horner": "assembled matrices, Horner form",
    "step/element": "element kernel",
    "step/edge_baseline": "edge kernel, baseline instructions",
    "step/edge_avx2": "edge kernel, AVX2",
    "step/edge_avx512": "edge kernel, AVX-512",
    "step/edge": "edge kernel, best instructions",
    "step2/edge": "edge kernel, two threads",
    "step2/element": "element kernel, two threads",
    "step/element_baseline": "element kernel, baseline instructions",
    "step/element_avx2": "element kernel, AVX2",
    "step/element_avx512": "element kernel, AVX-512",
}


def in_order(table):
    known = list(NAMES)
    return dict(sorted(table.items(), key=lambda item: known.index(item[0]) if item[0] in known else len(known)))


def print_start(start, steps):
    cells = []
    for size, records in sorted(start.items()):
        middle = nanoseconds(records)[0]
        step = f": {middle / nanoseconds(steps[size])[0]:.0f} steps" if size in steps else ""
        cells.append(f"{size_name(size)} {middle * size * 1e-6:.3g} ms{step}")
    print("\nStart-up, files apart, and how many steps take as long: " + "; ".join(cells) + ".")


def print_steps(table):
    sizes = sorted({size for row in table.values() for size in row})
    print("\n## One step, ns a triangle: median (spread)\n")
    print("| kernel | " + " | ".join(size_name(s) for s in sizes) + " |")
    print("|---" * (len(sizes) + 1) + "|")
    for kernel, row in table.items():
        cells = []
        for size in sizes:
            if size not in row:
                cells.append("")
                continue
            middle, spread = nanoseconds(row[size])
            cells.append(f"{middle:.3g} ({100 * spread:.0f} %)")
        print(f"| {NAMES.get(kernel, kernel)} | " + " | ".join(cells) + " |")
    baseline = table.get("step/csr")
    if not baseline:
        return
    print("\n## Times as fast as the baseline\n")
    print("| kernel | " + " | ".join(size_name(s) for s in sizes) + " |")
    print("|---" * (len(sizes) + 1) + "|")
    for kernel, row in table.items():
        if kernel == "step/csr":
            continue
        cells = [
            f"{nanoseconds(baseline[s])[0] / nanoseconds(row[s])[0]:.2g}" if s in row and s in baseline else ""
            for s in sizes
        ]
        print(f"| {NAMES.get(kernel, kernel)} | " + " | ".join(cells) + " |")


def print_peer(table):
    rows = [(s, r) for s, r in sorted(table.get("peer/rk4", {}).items()) if "error" in r[0]]
    for size, records in rows:
        r = records[0]
        print(
            f"\nAfter the same steps at {size_name(size)} triangles the peer's RK4 has an error of {r['error']:.3g}, "
            f"the engine's {r['error_engine']:.3g}; order {r['order']:.2f}, {r['evaluations/step']:.2f} evaluations a "
            "step."
        )


def bandwidth(found):
    """threads -> [(MB, bytes a second)], rising."""
    triad = {}
    for name, records in found.items():
        if not name.startswith("machine/triad/"):
            continue
        parts = name.split("/")
        threads = next((int(p.split(":")[1]) for p in parts if p.startswith("threads:")), 1)
        middle = statistics.median(r["bytes_per_second"] for r in records)
        triad.setdefault(threads, []).append((int(parts[2]), middle))
    return {threads: sorted(rows) for threads, rows in triad.items()}


def peak(found):
    flops = {n: statistics.median(r["flops"] for r in rs) for n, rs in found.items() if n.startswith("machine/fma/")}
    return flops


def at_size(rows, megabytes):
    """The bandwidth measured at the nearest size, by ratio."""
    return min(rows, key=lambda row: max(row[0] / megabytes, megabytes / row[0]))[1]


ROOFLINE = ["step/csr", "step/edge", "step2/edge", "step/element", "step2/element"]


def nearness(records, size, rates, peak_flops):
    """Of a kernel's step: bytes and flops a second, and their shares of what the machine does."""
    r = records[0]
    seconds = nanoseconds(records)[0] * 1e-9
    # Four sweeps move the bytes; what they touch is a quarter of it.
    rate = at_size(rates, max(r["bytes/tri"] * size / 4 * 1e-6, 0.1))
    moved, done = r["bytes/tri"] / seconds, r["flops/tri"] / seconds
    bound = max(r["bytes/tri"] / rate, r["flops/tri"] / peak_flops)
    return {"moved": moved, "of_bandwidth": moved / rate, "done": done, "of_peak": done / peak_flops,
            "of_bound": bound / seconds}


def print_roofline(table, found):
    triad, flops = bandwidth(found), peak(found)
    print("\n## The machine\n")
    print("| triad, MB in use | " + " | ".join(str(mb) for mb, _ in triad[1]) + " |")
    print("|---" * (len(triad[1]) + 1) + "|")
    for threads, rows in sorted(triad.items()):
        cells = " | ".join(f"{rate * 1e-9:.3g}" for _, rate in rows)
        print(f"| {threads} thread{'s' if threads > 1 else ''}, GB/s | {cells} |")
    print("\n" + "; ".join(f"{n.split('/')[-1]}: {f * 1e-9:.3g} Gflop/s" for n, f in flops.items()) + " in registers.")
    print("\n## How near a step comes: bytes and flops it must at least move and do\n")
    print("The bound is the larger of bytes / bandwidth (at the size of what a step touches) and flops / peak.\n")
    print("| kernel | triangles | bytes/tri | flops/tri | GB/s | of bandwidth | Gflop/s | of peak | of the bound |")
    print("|---|---|---|---|---|---|---|---|---|")
    top = max(flops.values())
    for kernel in ROOFLINE:
        threads = 2 if kernel.startswith("step2") else 1
        for size, records in sorted(table.get(kernel, {}).items()):
            r = records[0]
            near = nearness(records, size, triad.get(threads, triad[1]), top * threads)
            print(
                f"| {NAMES.get(kernel, kernel)} | {size_name(size)} | {r['bytes/tri']:.0f} | {r['flops/tri']:.0f} | "
                f"{near['moved'] * 1e-9:.3g} | {100 * near['of_bandwidth']:.0f} % | {near['done'] * 1e-9:.3g} | "
                f"{100 * near['of_peak']:.0f} % | {100 * near['of_bound']:.0f} % |"
            )
    print_passes(table, triad)
    print(
        "\nMore than 100 % of the bandwidth: all of a step's sweeps pass through the mesh together, so that bytes "
        "counted sweep by sweep come from cache."
    )


def print_passes(table, triad):
    """Where the mesh is larger than the caches, what one pass a step moves through memory."""
    for kernel in ROOFLINE:
        threads = 2 if kernel.startswith("step2") else 1
        for size, records in sorted(table.get(kernel, {}).items()):
            passed = records[0].get("pass_bytes/tri", 0.0)
            if passed * size < 1e8:  # in cache
                continue
            megabytes, rate = triad.get(threads, triad[1])[-1]
            moved = passed / (nanoseconds(records)[0] * 1e-9)
            print(
                f"\n{NAMES[kernel]}, {size_name(size)}: one pass a step moves {passed:.0f} bytes a triangle through "
                f"memory: {moved * 1e-9:.3g} GB/s, {100 * moved / rate:.0f} % of the triad's at {megabytes} MB."
            )


def print_agreement(table):
    """Whether one and two threads end in the same bits (the label is a hash of the state)."""
    for kernel in ("edge", "element"):
        one, two = table.get(f"step/{kernel}", {}), table.get(f"step2/{kernel}", {})
        for size in sorted(set(one) & set(two)):
            hashes = {r["label"] for r in one[size] + two[size]}
            if len(hashes) != 1:
                sys.exit(f"{kernel} kernel, {size} triangles: runs end in different states: {sorted(hashes)}")
    print("\nAll runs of a kernel end in the same bits, on one thread and on two.")


def refined_beam(triangles, folder):
    """The paper's beam (1 m x 0.25 m) with about so many triangles, its inner nodes moved at random; a scene file."""
    rows = max(1, round((triangles / 8) ** 0.5))
    columns = 4 * rows
    size = 0.25 / rows
    chance = random.Random(1)
    points = []
    for row in range(rows + 1):
        for column in range(columns + 1):
            inner = 0 < row < rows and 0 < column < columns
            dx, dy = (chance.uniform(-0.25 * size, 0.25 * size) if inner else 0.0 for _ in range(2))
            points.append([column * size + dx, row * size + dy])

    def at(row, column):
        return row * (columns + 1) + column

    corners = []
    for row in range(rows):
        for column in range(columns):
            bl, br, tl, tr = at(row, column), at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)
            falling = (row + column) % 2 == 0
            corners += [[bl, br, tl], [tr, tl, br]] if falling else [[bl, br, tr], [bl, tr, tl]]
    left = [[at(row, 0), at(row + 1, 0)] for row in range(rows)]
    right = [[at(row, columns), at(row + 1, columns)] for row in range(rows)]
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"beam_{size_name(triangles)}.toml"
    file.write_text(
        f"""title = "Beam, {len(corners)} triangles"
[mesh]
points = {points}
triangles = {corners}
[edges]
left = {left}
right = {right}
[material]
lambda_ela = 7.0
mu_ela = 5.0
lambda_vis = 4.0
mu_vis = 2.0
density = 0.2
[[fix]]
edges = "left"
[[traction]]
edges = "right"
vector = [5.0, 0.0]
until = 1.0
[time]
duration = 2.0
frame_rate = 60
"""
    )
    return file


ORDERS = {"rk4": 4, "euler": 1, "implicit": 8}


def seconds_to_reach(runs, level):
    """The least median of the runs that reach it; else the finest one's, carried on by the integrator's order."""
    reached = [statistics.median(r["seconds"]) for r in runs if r["error"] is not None and r["error"] <= level]
    if reached:
        return min(reached), ""
    usable = [r for r in runs if r["error"] and r["error"] <= 1e-2]  # where the order shows
    if not usable or runs[0]["integrator"] not in ORDERS:
        return None, ""
    finest = min(usable, key=lambda r: r["error"])
    order = ORDERS[finest["integrator"]]
    return statistics.median(finest["seconds"]) * (finest["error"] / level) ** (1.0 / order), " (by its order)"


def print_reach(report):
    names = list(dict.fromkeys(r["integrator"] for r in report["runs"]))
    print("\n| seconds to reach | " + " | ".join(names) + " | rk4 / exponential |")
    print("|---" * (len(names) + 2) + "|")
    for level in (1e-3, 1e-5, 1e-9):
        found = {n: seconds_to_reach([r for r in report["runs"] if r["integrator"] == n], level) for n in names}
        cells = [f"{s:.3g}{how}" if s is not None else "" for s, how in found.values()]
        pair = [found.get(n, (None, ""))[0] for n in ("rk4", "exponential")]
        ratio = f"{pair[0] / pair[1]:.1f}" if all(pair) else ""
        print(f"| {level:.0e} | " + " | ".join(cells) + f" | {ratio} |")


def print_integrators(arguments):
    program = arguments.build / "app" / "rheo"
    scenes = [TOP / "app" / "scenes" / f"{name}.toml" for name in arguments.scenes.split(",") if name]
    scenes += [refined_beam(int(size), arguments.out) for size in arguments.refined.split(",") if size]
    for scene in scenes:
        folder = arguments.out / scene.stem
        command = [str(program), "bench", str(scene), "-o", str(folder), "--force", "--budget", str(arguments.budget)]
        if arguments.threads:
            command += ["--threads", str(arguments.threads)]
        print(f"running {' '.join(command)}", file=sys.stderr)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        report = json.loads((folder / "run.json").read_text())
        mesh, exact = report["mesh"], report["exact"]
        print(f"\n## {report['title']}: run time against error\n")
        check = f" ({exact['check']})" if exact["check"] else ""
        print(f"{mesh['nodes']} nodes, {mesh['triangles']} triangles; exact solution: {exact['method']}{check}.")
        print("\n| integrator | setting | kernel | threads | force evaluations | seconds (spread) | error |")
        print("|---|---|---|---|---|---|---|")
        for run in report["runs"]:
            setting = f"`--tolerance {run['tolerance']:g}`" if run["tolerance"] else f"`--step {run['step_asked']:g}`"
            middle, spread = median_and_spread(run["seconds"])
            times = f"{middle:.3g}" + (f" ({100 * spread:.0f} %)" if len(run["seconds"]) > 1 else " (1 run)")
            error = "" if run["error"] is None else f"{run['error']:.1e}"
            print(
                f"| {run['integrator']} | {setting} | {run['kernel']} | {run['threads']} | "
                f"{run['force_evaluations']} | {times} | {error} |"
            )
        for forecast in report["forecasts"]:
            print(f"\nNot measured: {forecast}")
        for left in report["left_out"]:
            print(f"\nLeft out: {left['what']}: {left['why']}")
        if report["runs"]:
            print_reach(report)
        print(f"\n{report['advice']}")
        if (folder / "bench.png").exists():
            print(f"\n![Run time against error]({folder / 'bench.png'})")


def print_step_tables(arguments, bench, sizes):
    table = by_kernel(run_benchmark(bench / "rheo_bench_step", f"^(step2?|start)/.*/({sizes})/|^start/({sizes})/",
                                    arguments))
    peer = bench / "rheo_bench_peer"
    if peer.exists():
        table.update(by_kernel(run_benchmark(peer, f"/({sizes})/", arguments)))
    table = in_order(table)
    start = table.pop("start", {})
    small = by_kernel(run_benchmark(bench / "rheo_bench_step", f"^(start|step/edge)/({SMALL_SIZES})/", arguments))
    print_steps(table)
    print_agreement(table)
    print("\nThe baseline is textbook code and has no threads; nor has the peer.")
    print_start({**small["start"], **start}, {**small["step/edge"], **table.get("step/edge", {})})
    if peer.exists():
        print_peer(table)
    else:
        print("\nThe peer was not built: install libsundials-dev, then configure and build again.")
    print_roofline(table, run_benchmark(bench / "rheo_bench_roofline", ".", arguments))


def print_skip_table(arguments, bench):
    found = run_benchmark(bench / "rheo_bench_skip", ".", arguments)
    render = bench / "rheo_bench_render"
    if render.exists():
        found.update(run_benchmark(render, "DrawAndReadBack.*triangles:10000/height:720", arguments))
    side_tables.print_skips(found)


def print_branch_tables(arguments, bench, sizes):
    step = bench / "rheo_bench_step"
    side_tables.print_branches(run_benchmark(step, f"^branches/.*/({sizes})/", arguments))
    side_tables.print_regions(run_benchmark(step, f"^regions/.*/({sizes})/", arguments))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=TOP / "build" / "release")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--min-time", default="0.2", help="seconds of a repetition")
    parser.add_argument("--max-triangles", type=int, default=1000000)
    parser.add_argument("--budget", type=float, default=240.0, help="seconds of `rheo bench` a scene")
    parser.add_argument("--scenes", default="beam,beam_fine", help="names of shipped scenes")
    parser.add_argument("--refined", default="1000,10000", help="triangles of the refined beams")
    parser.add_argument("--threads", type=int, help="of `rheo bench`")
    parser.add_argument("--only", default="", help="some of " + ", ".join(TABLES) + "; default: all")
    parser.add_argument("--frame-options", default="--seconds 2", help="of rheo_bench_frame_time")
    parser.add_argument("--out", type=pathlib.Path, default=TOP / "out" / "tables", help="folder of the pictures")
    arguments = parser.parse_args()

    only = arguments.only.split(",") if arguments.only else TABLES
    for name in only:
        if name not in TABLES:
            sys.exit(f"--only {name}: unknown; {', '.join(TABLES)} are allowed")
    bench = arguments.build / "tests" / "bench"
    if not (bench / "rheo_bench_step").exists():
        sys.exit(f"{bench}/rheo_bench_step is missing: build first (cmake --build --preset release)")
    print(f"{machine()}. Medians of {arguments.repetitions} interleaved runs, (slowest - fastest) / median in brackets.")
    sizes = "|".join(str(s) for s in (1000, 10000, 100000, 1000000) if s <= arguments.max_triangles)
    if "steps" in only:
        print_step_tables(arguments, bench, sizes)
    if "memory" in only and (bench / "rheo_bench_memory").exists():
        side_tables.print_memory(bench / "rheo_bench_memory", sizes.split("|"))
    if "branches" in only:
        print_branch_tables(arguments, bench, sizes)
    if "skips" in only:
        print_skip_table(arguments, bench)
    if "graded" in only:
        side_tables.print_graded(run_benchmark(bench / "rheo_bench_integrate", ".", arguments))
    if "pictures" in only and (bench / "rheo_bench_render").exists():
        side_tables.print_pictures(run_benchmark(bench / "rheo_bench_render", "^Sequence", arguments))
    if "frames" in only and (bench / "rheo_bench_frame_time").exists():
        side_tables.print_frames(bench / "rheo_bench_frame_time", arguments.frame_options.split())
    if "integrators" in only:
        print_integrators(arguments)


if __name__ == "__main__":
    main()
