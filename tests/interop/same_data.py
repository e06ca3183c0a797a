#!/usr/bin/env python3
"""Checks that two recordings hold the same chunks, row ids and values included.

    same_data.py ONE.rrd OTHER.rrd
"""
import sys

from rerun.experimental import RrdReader


def chunks(path):
    reader = RrdReader(path)
    stores = reader.recordings()
    return [(c.entity_path, c.to_record_batch()) for store in stores for c in reader.stream(store=store).to_chunks()]


def main():
    one, other = chunks(sys.argv[1]), chunks(sys.argv[2])
    assert len(one) == len(other), f"{len(one)} chunks against {len(other)}"
    for (path, a), (other_path, b) in zip(one, other):
        assert path == other_path and a.equals(b), f"{path} differs from {other_path}"
    print(f"{len(one)} chunks, all the same")


main()
