# SPDX-License-Identifier: Apache-2.0
"""Reads a web page of mercury export without a browser: an independent reading of what app/export/page_numbers.h says."""

import base64
import json
import re
import zlib

import numpy as np


class Page:
    def __init__(self, path):
        self.text = path.read_text()
        self.description = json.loads(self.element("page"))
        self.robots = self.description["robots"]

    def element(self, name):
        return re.search(rf'<script type="[a-z/]*" id="{name}">(.*?)</script>', self.text, re.DOTALL).group(1)

    def viewer_bytes(self):
        """Of the page without what it says of robots."""
        data = sum(len(self.element(f"robot-{i}")) for i in range(len(self.robots)))
        return len(self.text.encode()) - len(self.element("page").encode()) - data

    def tables(self, robot):
        data = zlib.decompress(base64.b64decode(self.element(f"robot-{robot}")))
        tables, begin = {}, 0
        for entry in self.robots[robot]["tables"]:
            shape, width = (entry["rows"], entry["columns"]), entry["width"]
            size = shape[0] * shape[1] * width
            planes = np.frombuffer(data[begin:begin + size], np.uint8).reshape(width, *shape).astype(np.int64)
            zigzag = sum((planes[byte] << (8 * byte) for byte in range(width)), np.zeros(shape, np.int64))
            values = np.where(zigzag % 2 == 0, zigzag // 2, -(zigzag + 1) // 2)
            # Differences of some order; what is before the first row counts as nothing, then as no change.
            if entry["order"] == 2 and len(values) > 1:
                values[1:] = np.cumsum(values[1:], axis=0)
            if entry["order"] > 0:
                values = np.cumsum(values, axis=0)
            tables[entry["name"]] = values
            begin += size
        assert begin == len(data)
        return tables

    def positions(self, robot):
        """[frame][mass][3], m"""
        table = self.tables(robot)["positions"]
        return table.reshape(len(table), -1, 3) * self.robots[robot]["step"]
