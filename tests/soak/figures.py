# SPDX-License-Identifier: Apache-2.0
"""gnuplot's pictures of a run: coverage, lag, bytes."""
import shutil
import subprocess

_HEAD = "set term pngcairo size 900,500; set grid; set key outside right; set xlabel 'seconds'\n"


def draw(out, start, *, coverage, lags, classes, kills):
    """False if there is no gnuplot: then the data lie there without pictures. `coverage`: title ->
    curve; `lags`: robot -> curve; `classes`: node -> {class: bytes}; `kills`: (time, node)."""
    _write_curves(out / "coverage.dat", start, coverage)
    _write_curves(out / "lag.dat", start, lags)
    names = sorted({name for sums in classes.values() for name, count in sums.items() if count})
    with open(out / "bytes.dat", "w") as file:
        file.write("node " + " ".join(names) + "\n")
        for node, sums in sorted(classes.items()):
            file.write(" ".join([node, *(f"{sums.get(name, 0) / 1000.0:.1f}" for name in names)]) + "\n")
    if shutil.which("gnuplot") is None:
        return False
    marks = "".join(f"set arrow from {when - start:.1f}, graph 0 to {when - start:.1f}, graph 1 nohead "
                    f"lc rgb 'grey' dt 2\n" for when, _ in kills)
    _plot(out, "coverage", marks + "set ylabel 'share of voxels'; set yrange [0:1.05]\n", coverage)
    _plot(out, "lag", marks + "set ylabel 'lag at the base, s'\n", lags)
    _gnuplot(f"{_HEAD}set output '{out / 'bytes.png'}'\nset style data histograms\n"
             "set style histogram rowstacked; set style fill solid; set boxwidth 0.7\n"
             "set xlabel ''; set ylabel 'kB sent'\n"
             f"plot for [i=2:{len(names) + 1}] '{out / 'bytes.dat'}' using i:xtic(1) "
             "title columnheader(i) noenhanced\n")
    return True


def _write_curves(path, start, curves):
    with open(path, "w") as file:
        for title, curve in curves.items():
            file.write(f'"{title}"\n')
            file.writelines(f"{when - start:.2f} {value:.4f}\n" for when, value in curve)
            file.write("\n\n")


def _plot(out, name, settings, curves):
    parts = ", ".join(f"'{out / (name + '.dat')}' index {i} using 1:2 with lines lw 2 title "
                      "columnheader(1) noenhanced" for i, curve in enumerate(curves.values()) if curve)
    if parts:
        _gnuplot(f"{_HEAD}set output '{out / (name + '.png')}'\n{settings}plot {parts}\n")


def _gnuplot(script):
    subprocess.run(["gnuplot"], input=script, text=True, check=True, timeout=60)
