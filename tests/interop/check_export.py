#!/usr/bin/env python3
"""Holds an export against Rerun's own Python reader, number by number and bit by bit.

    check_export.py RECORDING.rrd EXPORT.csv

EXPORT.csv is what `torquescope inspect RECORDING.rrd --export csv` wrote.
"""
import csv
import sys

from rerun.experimental import RrdReader

PARTS = {1: [""], 3: [".x", ".y", ".z"], 4: [".x", ".y", ".z", ".w"],
         9: [f".{a}{b}" for a in "xyz" for b in "xyz"]}


def read(path):
    """(body, ns) -> rows in order, each {column: value}."""
    reader = RrdReader(path)
    rows = {}
    for chunk in reader.stream(store=reader.recordings()[0]).to_chunks():
        parts = chunk.entity_path.strip("/").split("/")
        if chunk.is_static or parts[0] != "numbers" or len(parts) != 2:
            continue
        batch = chunk.to_record_batch()
        columns = {n: batch.column(n) for n in batch.schema.names if "RowId" not in n and n != "step"}
        for i in range(batch.num_rows):
            found = {}
            for name, column in columns.items():
                if name == "sim_time":
                    continue
                values = column[i].as_py() or []
                found |= {name + part: x for part, x in zip(PARTS.get(len(values), []), values)}
            rows.setdefault((parts[1], columns["sim_time"][i].value), []).append(found)
    return rows


def main():
    rows, numbers = read(sys.argv[1]), 0
    for row in csv.DictReader(open(sys.argv[2])):
        key = (row.pop("body"), round(float(row.pop("sim_time")) * 1e9))
        row.pop("recording")
        want = rows[key].pop(0)
        # Torques by source stand elsewhere.
        got = {name: float(x) for name, x in row.items() if x and not name.startswith("torque_by_")}
        assert got == want, f"{key}: {got} is not {want}"
        numbers += len(got)
    left = sum(len(more) for more in rows.values())
    assert left == 0, f"{left} rows are not exported"
    print(f"{numbers} numbers are the same")


main()
