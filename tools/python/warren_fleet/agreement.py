# SPDX-License-Identifier: Apache-2.0
"""Whether a fleet has one map: by the daemons' word, and by files that they write."""
import pathlib
import time

from . import processes
from .ledger import key_of


def own_layers(robots):
    """layer -> (revision, name) of what each robot writes now."""
    own = {}
    for robot in robots:
        publishing = robot.status().publishing
        if publishing.HasField("layer"):
            own[key_of(publishing.layer)] = (publishing.revision, robot.name)
    return own


def lag_of(node, origins):
    """Why `node` has not all of everybody yet; empty if it has."""
    have = {key_of(layer.layer): layer for other in node.fleet().nodes for layer in other.layers}
    for key, (revision, name) in origins.items():
        layer = have.get(key)
        if layer is None:
            return f"{node.name} has nothing of {name}"
        if layer.own:
            continue
        if layer.held_everywhere < revision or layer.lag_revisions > 0:
            return (f"{node.name} has {layer.held_everywhere} of {revision} revisions of {name}, "
                    f"which it thinks has {layer.latest}")
        if not layer.digest_equal:
            return f"{node.name} does not say that its digest of {name} is equal"
    return ""


def await_agreement(nodes, robots, limit_s, meanwhile=lambda: None):
    """Seconds until everybody said to have all of everybody; and what is missing, if not in time."""
    start = time.monotonic()
    while True:
        origins = own_layers(robots)
        missing = [lag for lag in (lag_of(node, origins) for node in nodes) if lag]
        took = time.monotonic() - start
        if not missing or took > limit_s:
            return took, missing
        meanwhile()
        time.sleep(0.25)


def digests_of(bin_dir, nodes, robot, work):
    """node's name -> digest of the layer of `robot` in the file that this node writes of it."""
    digests = {}
    for node in nodes:
        file = pathlib.Path(work) / f"{node.name}-of-{robot.name}.layer"
        of = {} if node is robot else {"of": robot.name}
        if node.save(file, **of) is None:
            digests[node.name] = "nothing"
            continue
        digests[node.name] = processes.run(
            [pathlib.Path(bin_dir) / "warrenctl", "layer", "digest", file]).split()[0]
        file.unlink()
    return digests
