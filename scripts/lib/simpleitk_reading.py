"""Reads a folder of DICOM files by SimpleITK's series reader and prints its seconds as JSON.

usage: simpleitk_reading.py DICOM_DIR

`find` sorts the files into series, `decode` reads the largest one.
"""

import json
import sys
import time

import SimpleITK as sitk


def main(folder: str) -> None:
    clock = time.perf_counter()
    reader = sitk.ImageSeriesReader()
    ids = reader.GetGDCMSeriesIDs(folder)
    names = [reader.GetGDCMSeriesFileNames(folder, uid) for uid in ids]
    found = time.perf_counter()
    reader.SetFileNames(max(names, key=len))
    image = reader.Execute()
    read = time.perf_counter()
    seconds = {"find": found - clock, "decode": read - found, "read": read - clock}
    print(json.dumps({"seconds": seconds, "voxels": image.GetNumberOfPixels()}))


if __name__ == "__main__":
    main(*sys.argv[1:])
