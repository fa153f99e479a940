# SPDX-License-Identifier: Apache-2.0
import numpy as np

import mercurysim


def test_positions_share_memory_with_the_batch():
    batch = mercurysim.Batch(mercurysim.random_voxel(4, seed=1), device="cpu")
    positions = np.asarray(batch.positions)
    before = positions.copy()
    batch.step(100)
    assert np.abs(positions - before).max() > 0
    assert np.from_dlpack(batch.positions).ctypes.data == positions.ctypes.data
