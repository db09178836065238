"""Small HDF5 files in the layouts of data sets, as seeds for fuzzing: hdf5_seeds.py FOLDER"""
import sys

import h5py
import numpy as np

n = 60
i = np.arange(n)
x, y, p, t = (i % 64).astype("u2"), (i * 3 % 48).astype("u2"), (i % 2).astype("u1"), 5 + 11 * i
ts, w, a = 100 + 1000 * np.arange(5), np.ones((5, 3)), np.full((5, 3), 5.5)


def file(name):
    return h5py.File(f"{sys.argv[1]}/{name}", "w")


with file("dsec_gzip") as f:
    for key, data in dict(x=x, y=y, p=p, t=t.astype("u4")).items():
        f.create_dataset(f"events/{key}", data=data, compression="gzip", shuffle=True, chunks=(32,))
    f["t_offset"] = np.int64(7000)
with file("m3ed_lzf") as f:
    for key, data in dict(x=x, y=y, p=p, t=t).items():
        f.create_dataset(f"prophesee/left/{key}", data=data, compression="lzf", fletcher32=True, chunks=(32,))
    f["prophesee/left/calib/resolution"] = np.array([64, 48])
    f["ovc/imu/ts"], f["ovc/imu/omega"], f["ovc/imu/accel"] = ts, w, a
with file("mvsec") as f:
    f["davis/left/events"] = np.stack([x, y, t * 1e-6, np.where(p, 1.0, -1.0)], axis=1)
    f["davis/left/imu"], f["davis/left/imu_ts"] = np.hstack([a, w]), ts * 1e-6
with file("e2calib") as f:
    f["x"], f["y"], f["p"], f["t"] = x, y, p, t
pictures = (np.arange(5 * 4 * 6) % 251).astype("u1").reshape(5, 4, 6, 1)
for name, options in dict(plain={}, gzip=dict(chunks=(1, 4, 6, 1), compression="gzip"),
                          lzf=dict(chunks=(2, 3, 4, 1), compression="lzf")).items():
    with file(f"pictures_{name}") as f:
        f["ovc/ts"] = ts
        f.create_dataset("ovc/left/data", data=pictures, **options)
with file("pictures_mvsec") as f:
    f["davis/left/image_raw"], f["davis/left/image_raw_ts"] = pictures[..., 0], ts * 1e-6
