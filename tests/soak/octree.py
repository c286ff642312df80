# SPDX-License-Identifier: Apache-2.0
"""OctoMap's .ot files: how many voxels differ."""
import struct

DEPTH = 16
EMPTY = b"# Octomap OcTree file\nid OcTree\nsize 0\nres 1\ndata\n"
_NODE = struct.Struct("<fB")


class Tree:
    """The nodes of a file, in its order: log-odds and which children there are."""

    def __init__(self, data):
        head, separator, self._nodes = data.partition(b"\ndata\n")
        if not separator or b"\nid OcTree\n" not in head:
            raise ValueError("no .ot file")
        self.size = next((int(line.split()[1]) for line in head.split(b"\n")
                          if line.startswith(b"size ")), 0)
        self._place = 0

    def next(self):
        node = _NODE.unpack_from(self._nodes, self._place)
        self._place += _NODE.size
        return node


def read(path):
    with open(path, "rb") as file:
        return Tree(file.read())


def count_voxels(tree, level, mask):
    """Known ones in the subtree whose root has just been read."""
    if mask == 0:
        return 8 ** level
    return sum(count_voxels(tree, level - 1, tree.next()[1])
               for child in range(8) if mask >> child & 1)


def count_different(one, other):
    """Voxels that are not known alike, with the same log-odds, in both."""
    if one.size == 0 or other.size == 0:
        filled = other if one.size == 0 else one
        return 0 if filled.size == 0 else count_voxels(filled, DEPTH, filled.next()[1])
    return _compare(one, one.next(), other, other.next(), DEPTH)


def _compare(one, node, other, other_node, level):
    masks = node[1], other_node[1]
    if masks == (0, 0):
        return 0 if node[0] == other_node[0] else 8 ** level
    if 0 in masks:
        pruned, tree, mask = ((node, other, masks[1]) if masks[0] == 0 else
                              (other_node, one, masks[0]))
        return 8 ** level - _count_like(tree, level, mask, pruned[0])
    different = 0
    for child in range(8):
        has = masks[0] >> child & 1, masks[1] >> child & 1
        if has == (1, 1):
            different += _compare(one, one.next(), other, other.next(), level - 1)
        elif has == (1, 0):
            different += count_voxels(one, level - 1, one.next()[1])
        elif has == (0, 1):
            different += count_voxels(other, level - 1, other.next()[1])
    return different


def _count_like(tree, level, mask, log_odds):
    """Voxels with these log-odds in a subtree whose root, just read, is not pruned."""
    same = 0
    for child in range(8):
        if not mask >> child & 1:
            continue
        value, below = tree.next()
        if below != 0:
            same += _count_like(tree, level - 1, below, log_odds)
        elif value == log_odds:
            same += 8 ** (level - 1)
    return same
