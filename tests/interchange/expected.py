"""What the samples must hold, from the bare numbers beside them."""

from pathlib import Path

import numpy as np

FRAMES = 10
FRAME_RATE = 24.0


class Expected:
    def __init__(self, folder):
        folder = Path(folder)
        self.folder = folder
        self.points = np.fromfile(folder / "points.f32", "<f4").reshape(FRAMES, -1, 3)
        # Column by column: the transpose of each is the matrix that multiplies rows.
        self.poses = np.fromfile(folder / "poses.f32", "<f4").reshape(FRAMES, 4, 4).astype("f8")
        self.counts = np.fromfile(folder / "counts.u32", "<u4").astype(int)
        self.strands = len(self.counts)
        self.size = float(np.ptp(self.points[0], axis=0).max())
        n = self.points.shape[1]
        self.widths = (np.float32(0.008) + np.float32(0.0001) * np.arange(n, dtype="f4")).astype("f8")
        self.ids = 100 + 3 * np.arange(self.strands)
        self.groups = 4 * (np.arange(self.strands) % 2)
        self.group_names = ["fringe" if g == 0 else 'back "of" head' for g in self.groups]
        self.guides = (np.arange(self.strands) % 7 == 2).astype(int)
        self.root_uvs = np.stack([np.arange(self.strands) / self.strands, np.full(self.strands, 0.25)], 1)
        self.colors = np.stack([np.full(n, 0.1), 0.05 + 0.001 * np.arange(n), np.full(n, 0.02)], 1)

    def near(self, found, expected, what):
        """Equal to 1e-5 of the size."""
        error = float(np.abs(np.asarray(found, "f8") - expected).max())
        assert error <= 1e-5 * self.size, f"{what}: off by {error}"

    def in_world(self, frame):
        """Points of a frame under the moving head."""
        rows = np.c_[self.points[frame].astype("f8"), np.ones(self.points.shape[1])]
        return (rows @ self.poses[frame])[:, :3]
