#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""lineage.csv follows the ALife data standard for phylogenies, and its tools read it.

    lineage_test.py standard|tools WRITE_TEST_RUNS

https://alife-data-standards.github.io/alife-data-standards/phylogeny
"""

import csv
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def ancestors_of(row):
    if row["ancestor_list"] == "[none]":
        return []
    assert re.fullmatch(r"\[\d+(,\d+)*\]", row["ancestor_list"]), row["ancestor_list"]
    return [int(text) for text in row["ancestor_list"][1:-1].split(",")]


def check_standard(run):
    rows = rows_of(run / "lineage.csv")
    assert list(rows[0])[:4] == ["id", "ancestor_list", "origin_time", "destruction_time"]
    assert all(None not in row and None not in row.values() for row in rows), "lines of different lengths"
    by_id = {int(row["id"]): row for row in rows}
    assert len(by_id) == len(rows), "ids are not unique"
    living = 0
    for row in rows:
        origin, end = float(row["origin_time"]), float(row["destruction_time"])
        assert origin <= end and not math.isnan(end)
        living += math.isinf(end)
        for ancestor in ancestors_of(row):
            parent = by_id[ancestor]  # they are in the file
            assert float(parent["origin_time"]) < origin <= float(parent["destruction_time"]) + 1
        assert float(row["score"] if "score" in row else row["score_1"]) <= math.inf
        assert re.fullmatch(r"[0-9a-f]{16}", row["hash"])
    generations = rows_of(run / "generations.csv")
    assert living == int(generations[-1]["living"])
    assert len(rows) == sum(int(row["born"]) for row in generations)
    for row in generations:
        fates = sum(int(row[name]) for name in ("sound", "stopped", "exploded", "overstretched", "too_small", "undefined", "failed"))
        assert fates == int(row["born"])
    trees = rows_of(run / "first_parents.csv")
    scores = [name for name in rows[0] if re.fullmatch(r"score(_\d+)?", name)]
    assert list(trees[0]) == ["id", "ancestor_list", "origin_time", "destruction_time", "generation", *scores]
    for row, tree in zip(rows, trees, strict=True):
        assert ancestors_of(tree) == ancestors_of(row)[:1]
        assert all(tree[name] == row[name] for name in tree if name != "ancestor_list")
    picture = ElementTree.parse(run / "progress.svg")
    assert picture.getroot().tag == "{http://www.w3.org/2000/svg}svg"
    if run.name == "afpo":
        assert any(len(ancestors_of(row)) == 2 for row in rows), "nobody has two parents"


def check_tools(run):
    import alifedata_phyloinformatics_convert as tools
    import pandas
    from alifedata_phyloinformatics_convert._impl.alifestd_validate import alifestd_validate

    table = pandas.read_csv(run / "lineage.csv")
    rows = rows_of(run / "lineage.csv")
    assert len(table) == len(rows)
    if run.name == "one-parent":
        assert alifestd_validate(table)
    graph = tools.alife_dataframe_to_networkx_digraph(table, setup_edge_lengths=True)
    edges = {(int(row["id"]), parent) for row in rows for parent in ancestors_of(row)}
    assert set(graph.edges) == edges
    assert graph.number_of_nodes() == len(rows)
    assert all(length["length"] >= 1 for _, _, length in graph.edges(data=True))
    table = pandas.read_csv(run / "first_parents.csv")
    trees = tools.alife_dataframe_to_dendropy_trees(table, setup_edge_lengths=True)
    assert sum(len(tree.nodes()) for tree in trees) == len(rows)
    roots = [row for row in rows if row["ancestor_list"] == "[none]"]
    assert len(trees) == len(roots)
    check_phylotrack(run, rows, roots)


def check_phylotrack(run, rows, roots):
    try:
        from phylotrackpy import systematics
    except ImportError:
        print("phylotrackpy is not installed")
        return
    phylogeny = systematics.Systematics(lambda individual: individual, True, True, False, False)
    phylogeny.load_from_file(str(run / "first_parents.csv"), "id", assume_leaves_extant=False)
    assert phylogeny.get_num_active() == sum(row["destruction_time"] == "inf" for row in rows)
    assert phylogeny.get_num_taxa() == len(rows)
    assert phylogeny.get_num_roots() == len(roots)


def main():
    what, program = sys.argv[1:]
    if what == "tools":
        try:
            import alifedata_phyloinformatics_convert  # noqa: F401
        except ImportError:
            print("skipped: alifedata-phyloinformatics-convert is not installed")
            return
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, folder], check=True)
        runs = sorted(Path(folder).iterdir())
        assert len(runs) == 5
        for run in runs:
            (check_tools if what == "tools" else check_standard)(run)
            print(f"{run.name}: {len(rows_of(run / 'lineage.csv'))} individuals")


if __name__ == "__main__":
    main()
