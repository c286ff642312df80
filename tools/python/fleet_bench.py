#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a fleet of real daemons costs and how late it is, behind emulated radios: the numbers of tools/bench
fleet, as JSON. Needs root."""
import argparse
import json
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/python"))
sys.dont_write_bytecode = True

from warren_fleet import agreement, costs, link, measures, processes, protocol  # noqa: E402
from warren_fleet.driving import World, summary_of  # noqa: E402
from warren_fleet.fleet import Fleet  # noqa: E402
from warren_fleet.ledger import Ledger, Observer  # noqa: E402
from warren_fleet.load import ProcessLoad  # noqa: E402

BIN = ROOT / "build/release/bin"
DELAY_MS = 10
LOSSES = (0.0, 0.05, 0.2, 0.4)
RATES_BIT_S = (5e4, 2e5, 1e6, 1e7)
APART_MIN = (1, 10, 60)


class Trial:
    """One fleet in a cave: from its start to its end, whatever happens between."""

    def __init__(self, *, robots=1, seconds=60.0, tick_s=1.0, columns=1024, scan_hz=10.0, rate=1e6,
                 loss=0.0, shared=False, group_packets=False, stagger_s=0.0, resolution_m=0.1,
                 range_m=20.0, pace="real"):
        self._folder = tempfile.TemporaryDirectory(prefix="warren-bench-", ignore_cleanup_errors=True)
        self.work = pathlib.Path(self._folder.name)
        self.seconds, self.columns, self.scan_hz, self.pace = seconds, columns, scan_hz, pace
        self.rate, self.loss = rate, loss
        control_pb2, _ = protocol.make_modules(self.work / "proto")
        settings = {"layer": [f"tick_s: {tick_s}", "flush_after_s: 5"],
                    "map": [f"resolution_m: {resolution_m}"],
                    "sensors": ["- name: lidar", f"  max_range_m: {range_m}"]}
        self.world = World(BIN, preset="cave", seed=1, seconds=seconds, robots=robots,
                           length_m=max(250, round(0.8 * seconds)), stagger_s=stagger_s)
        self.fleet = Fleet(BIN, control_pb2, self.work, robots=robots, settings=settings)
        self.ledger = Ledger(self.work / "ledger.jsonl")
        self.rates = measures.Rates([node.name for node in self.fleet.nodes])
        self.options = ["--rate", rate, "--loss", loss, "--delay-ms", DELAY_MS, "--queue-ms", 400,
                        "--neighbour-retry-ms", 100, *(["--shared-airtime"] if shared else [])]
        self.group_packets = group_packets
        self.observers, self.sim, self.span = [], None, (0.0, 0.0)

    def __enter__(self):
        try:
            self.fleet.start_in_namespaces(self.options, group_packets=self.group_packets)
        except BaseException:
            self.__exit__()
            raise
        self.observers = [Observer(node, self.ledger) for node in self.fleet.nodes]
        return self

    def __exit__(self, *_):
        for observer in self.observers:
            observer.stop()
        if self.sim is not None and self.sim.poll() is None:
            self.sim.kill()
            self.sim.wait()
        self.fleet.close()
        self.ledger.close()
        self._folder.cleanup()

    def drive(self):
        """Until the robots have seen all; how many scans they sent and how many were mapped."""
        self.sim = self.world.drive([robot.ingest for robot in self.fleet.robots],
                                    self.work / "sim.log", columns=self.columns,
                                    rate_hz=self.scan_hz, pace=self.pace)
        start = time.time()
        while self.sim.poll() is None:
            self.rates.note(time.time(), self.fleet.link.stats())
            time.sleep(1.0)
        self.span = (start, time.time())
        summary = summary_of(self.work / "sim.log")
        if summary is None:
            raise RuntimeError((self.work / "sim.log").read_text()[-500:])
        return {"scans_sent": summary["sent"], "scans_taken": summary["taken"]}

    def kb_per_s(self):
        names = {robot.name for robot in self.fleet.robots}
        return spread("kb_per_s", self.rates.of(names, *self.span))

    def lag(self):
        found = [*measures.lags(self.ledger, *self.span),
                 *measures.first_lags(self.ledger, *self.span)]
        return spread("lag_s", [lag for _, _, lag in found])

    def settle(self, limit_s):
        """Seconds until all have all, counted from now; None if not in time."""
        took, missing = agreement.await_agreement(self.fleet.nodes, self.fleet.robots, limit_s)
        return None if missing else took

    def flush(self):
        time.sleep(2.5)
        for robot in self.fleet.robots:
            robot.ask(layer_flush={})

    def stats(self):
        return self.fleet.link.stats()


def spread(name, values):
    return {f"{name}_p{round(100 * share)}": measures.percentile(values, share)
            for share in (0.5, 0.95)}


def ticks(quick):
    """One robot at the reference load, alone with the base on a good link."""
    for tick_s in (1.0, 10.0):
        with Trial(tick_s=tick_s, seconds=20.0 if quick else 120.0) as trial:
            load = ProcessLoad(trial.fleet.robots[0].pid)
            at_base = ProcessLoad(trial.fleet.base.pid)
            scans = trial.drive()
            yield {"tick_s": tick_s, **scans, **trial.kb_per_s(), **trial.lag(),
                   "robot": load.read(), "base": at_base.read(),
                   "store_kb": trial.fleet.robots[0].status().store.file_bytes / 1000}


def lag_grid(quick):
    """The same robot with a lighter lidar, over links that lose and are slow."""
    for rate in (RATES_BIT_S if not quick else (1e6,)):
        for loss in (LOSSES if not quick else (0.2,)):
            with Trial(rate=rate, loss=loss, columns=512, scan_hz=5.0, resolution_m=0.15,
                       range_m=10.0, seconds=20.0 if quick else 60.0) as trial:
                scans = trial.drive()
                trial.flush()
                yield {"rate_bit_s": rate, "loss": loss, **scans, **trial.kb_per_s(), **trial.lag(),
                       "caught_up_after_s": trial.settle(60.0)}


def catch_up(quick):
    """A robot that maps out of reach, then meets the base. It maps as fast as the daemon can, so that
    an hour takes minutes; what is made up is the way that it drove in that time."""
    for minutes in ((0.5,) if quick else APART_MIN):
        for loss in (0.0, 0.2):
            with Trial(seconds=60.0 * minutes, loss=loss, columns=512, scan_hz=2.0, pace="max",
                       resolution_m=0.15, range_m=10.0) as trial:
                trial.fleet.link.tell("off")
                scans = trial.drive()
                trial.flush()
                before = received_bytes(trial.fleet.base)
                trial.fleet.link.tell("on")
                took = trial.settle(600.0)
                got = received_bytes(trial.fleet.base) - before
                status = trial.fleet.robots[0].status().map
                known = status.voxels_free + status.voxels_occupied
                ideal_s = 8.0 * got / (trial.rate * (1.0 - loss))
                yield {"apart_min": minutes, "loss": loss, **scans, "seconds": took,
                       "map_bytes": got, "voxels": known, "bits_per_voxel": 8.0 * got / known,
                       "efficiency": None if took is None else ideal_s / took}


def received_bytes(node):
    return sum(other.link.received.fresh_bytes + other.link.received.backlog_bytes
               for other in node.fleet().nodes if other.HasField("link"))


def crowd(quick):
    """Ten robots and a base that share one channel."""
    for group_packets in (False, True):
        with Trial(robots=3 if quick else 10, seconds=20.0 if quick else 90.0, stagger_s=3.0,
                   columns=128, scan_hz=2.0, shared=True, group_packets=group_packets,
                   resolution_m=0.15, range_m=10.0, loss=0.05) as trial:
            scans = trial.drive()
            trial.flush()
            took = trial.settle(240.0)
            nodes = trial.stats()["nodes"]
            airtime_s = 8.0 * sum(node["sent_bytes"] for node in nodes) / trial.rate
            # Known once everybody has all.
            known = sum(history[-1][2] for history in trial.ledger.mapped.values())
            delivered = 0 if took is None else known * len(trial.fleet.robots)
            yield {"robots": len(trial.fleet.robots), "group_packets": group_packets, **scans,
                   **trial.kb_per_s(), **trial.lag(), "caught_up_after_s": took,
                   "airtime_s": airtime_s, "voxels_delivered": delivered,
                   "airtime_us_per_voxel": 1e6 * airtime_s / delivered if delivered else None}


def on_loopback(part):
    return lambda quick: part(BIN, quick)


PARTS = {"ticks": ticks, "lag": lag_grid, "catch_up": catch_up, "crowd": crowd,
         "base": on_loopback(costs.at_the_base), "everything": on_loopback(costs.everything),
         "store": on_loopback(costs.start_again)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", default=list(PARTS), help=" ".join(PARTS))
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    if why := link.why_not():
        print(f"SKIPPED: {why}", file=sys.stderr)
        return 77
    if unknown := set(arguments.parts) - set(PARTS):
        parser.error(f"no part {' '.join(sorted(unknown))}")
    processes.clean_up_on_signals()
    result = {}
    for part in arguments.parts:
        result[part] = []
        for row in PARTS[part](arguments.quick):
            print(json.dumps({part: row}), file=sys.stderr, flush=True)
            result[part].append(row)
    print(json.dumps(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
