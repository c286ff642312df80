#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Three robots and a base share the map of a simulated world, live: what tools/demo runs. In network
namespaces behind the world's own radio as root, over the loopback interface otherwise."""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/python"))
sys.dont_write_bytecode = True

from warren_fleet import agreement, link, measures, processes, protocol, radio  # noqa: E402
from warren_fleet.driving import World, summary_of  # noqa: E402
from warren_fleet.fleet import Fleet  # noqa: E402
from warren_fleet.ledger import Ledger, Observer  # noqa: E402

BIN = ROOT / "build/release/bin"
ROBOTS = 3
LOSS = 0.1
RATE_BIT_S = 1e6
LEAD_S = 10.0
AGREEMENT_S = 90.0
SETTINGS = {"layer": ["flush_after_s: 5"], "map": ["resolution_m: 0.1"],
            "sensors": ["- name: lidar", "  max_range_m: 20.0"]}
MERGE, COST, ROBOT = 1, 1, 2  # as control.proto numbers sources and colours
FILES = {"merge.ply": {"source": MERGE}, "merge.pcd": {"source": MERGE}, "merge.bt": {"source": MERGE},
         "height.png": {"source": MERGE}, "robots.png": {"source": MERGE, "colours": ROBOT},
         "terrain.png": {"source": MERGE, "colours": COST},
         **{f"robot-{i}.layer": {"of": f"robot-{i}"} for i in range(ROBOTS)}}


def forget_last_run(out):
    """What is found there at the end is of this run, or not there."""
    out.mkdir(parents=True, exist_ok=True)
    for file in (*(out / name for name in FILES), *out.glob("*.log"), *out.glob("world/*.png")):
        file.unlink(missing_ok=True)


class Demo:
    def __init__(self, arguments, work):
        self.out, self.work, self.seconds = arguments.out, work, arguments.seconds
        control_pb2, _ = protocol.make_modules(work / "proto")
        self.world = World(BIN, preset=arguments.world, seed=arguments.seed, seconds=self.seconds,
                           robots=ROBOTS, stagger_s=min(8.0, self.seconds / 8))
        self.preset, self.seed = arguments.world, arguments.seed
        self.fleet = Fleet(BIN, control_pb2, work, robots=ROBOTS, settings=SETTINGS)
        self.ledger = Ledger(self.out / "ledger.jsonl")
        self.observers, self.sim, self.from_s = [], None, 0.0

    def run(self):
        self.start()
        self.drive()
        agreed = self.agree()
        for observer in self.observers:
            observer.stop()
        # All three, and each says what is wrong.
        return all([self.save(), self.summarise(), agreed])

    def start(self):
        why = link.why_not()
        if why:
            print(f"== three robots and a base, over the loopback interface ({why})", flush=True)
            self.fleet.start_on_loopback()
            return
        print(f"== three robots and a base in network namespaces: {RATE_BIT_S / 1e6:g} Mbit/s each, "
              f"{100 * LOSS:g} % of packets lost, and the world's own radio", flush=True)
        self.fleet.start_in_namespaces(["--trace", self.trace(), "--delay-ms", "5", "--queue-ms",
                                        "400", "--neighbour-retry-ms", "100"])

    def trace(self):
        """The world's radio, until the robots are called back into reach at the end."""
        rows = radio.read(self.world.radio(self.work))
        end_s = LEAD_S + self.seconds + 1.0
        trace = [row for row in radio.worsened(rows, delay_s=LEAD_S, loss=LOSS, blackouts=[])
                 if row.time_s < end_s]
        trace += radio.healed(rows, at_s=end_s, loss=LOSS, rate_bit_s=RATE_BIT_S)
        path = self.work / "trace.csv"
        radio.write(path, sorted(trace, key=lambda row: row.time_s))
        return path

    def drive(self):
        self.observers = [Observer(node, self.ledger) for node in self.fleet.nodes]
        print(f"== they explore: {self.preset}, seed {self.seed}, {self.seconds:g} s in real time",
              flush=True)
        self.from_s = time.time()
        self.sim = self.world.drive([robot.ingest for robot in self.fleet.robots],
                                    self.work / "sim.log", columns=512, rate_hz=5.0)
        shown = self.from_s
        while self.sim.poll() is None:
            if time.time() > self.from_s + self.seconds + 60.0:
                raise RuntimeError("the robots take too long")
            time.sleep(0.5)
            if time.time() - shown >= 10.0:
                shown = time.time()
                self.show()
        taken = summary_of(self.work / "sim.log")
        if self.sim.returncode != 0 or taken is None:
            raise RuntimeError("the robots stopped: " + (self.work / "sim.log").read_text()[-500:])
        print(f"   {taken['taken']} of {taken['sent']} scans are mapped", flush=True)

    def show(self):
        print(f"-- after {time.time() - self.from_s:.0f} s the base knows:")
        print(self.table(), flush=True)

    def table(self):
        return processes.run([BIN / "warrenctl", "--socket", self.fleet.base.socket, "fleet",
                              "status"])

    def agree(self):
        time.sleep(2.0)
        for robot in self.fleet.robots:
            robot.ask(layer_flush={})
        took, missing = agreement.await_agreement(self.fleet.nodes, self.fleet.robots, AGREEMENT_S)
        self.show()
        for lag in missing:
            print(f"   NOT ALL: {lag}")
        if not missing:
            print(f"== {took:.1f} s after the last was published everybody has the maps of all")
        return not missing

    def save(self):
        saved = True
        for name, fields in FILES.items():
            try:
                self.fleet.base.ask(map_save={"path": str(self.out / name)} | fields)
            except protocol.Refused as why:
                print(f"   NOT SAVED: {name}: {why}")
                saved = False
        processes.run([BIN / "warren-sim", "render", "--world", self.preset, "--seed", self.seed,
                       "--out", self.out / "world"], timeout_s=120.0)
        return saved

    def summarise(self):
        fleet = self.fleet
        span = (self.from_s, self.from_s + self.seconds)
        lags = sorted(lag for _, _, lag in [*measures.lags(self.ledger, *span),
                                            *measures.first_lags(self.ledger, *span)])
        print("== summary")
        for node in fleet.nodes:
            sent = self.ledger.classes.get(node.name, {})
            told = ", ".join(f"{name} {count / 1000:.0f}" for name, count in sorted(sent.items())
                             if count >= 500)
            total = node.fleet().ip_bytes_out / 1000
            print(f"   {node.name:8} sent {total:6.0f} kB in all; by class, kB: {told}")
        for share in (0.5, 0.95):
            lag = measures.percentile(lags, share)
            print(f"   lag at the base, p{100 * share:.0f}: {'-' if lag is None else f'{lag:.1f} s'}")
        equal = True
        for robot in fleet.robots:
            digests = agreement.digests_of(BIN, fleet.nodes, robot, self.work)
            same = len(set(digests.values())) == 1 and "nothing" not in digests.values()
            equal = equal and same
            print(f"   {robot.name}: digest {digests[robot.name][:16]}.. "
                  f"{'is equal on all four' if same else f'DIFFERS: {digests}'}")
        return equal

    def close(self):
        for observer in self.observers:
            observer.stop()
        if self.sim is not None and self.sim.poll() is None:
            self.sim.kill()
            self.sim.wait()
        self.fleet.close()
        self.ledger.close()
        for log in self.work.glob("*.log"):
            shutil.copy(log, self.out)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--world", default="cave")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/demo")
    arguments = parser.parse_args()
    shown, arguments.out = arguments.out, arguments.out.resolve()
    forget_last_run(arguments.out)
    processes.clean_up_on_signals()
    with tempfile.TemporaryDirectory(prefix="warren-demo-", ignore_cleanup_errors=True) as work:
        demo = Demo(arguments, pathlib.Path(work))
        try:
            good = demo.run()
        except (OSError, RuntimeError, protocol.Refused, subprocess.SubprocessError) as error:
            print(f"tools/demo: {error}", file=sys.stderr)
            return 1
        finally:
            demo.close()
    if not good:
        print("== FAILED: see what is in capitals above", flush=True)
        return 1
    print(f"== done: look at {shown}/robots.png (who mapped what) and {shown}/terrain.png (how hard the "
          f"ground is to drive), beside {shown}/world")
    print(processes.run(["ls", "-l", arguments.out]), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
