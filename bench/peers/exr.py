#!/usr/bin/env python3
"""CPU seconds of the OpenEXR library on the heights of a .npy file: exr.py FILE REPETITIONS

One channel Y of f32, ZIP of 16 scan lines, its default level, one thread. Prints one line of JSON: seconds of this process, and the bytes of the file.
"""
import json
import os
import sys
import tempfile
import time

import numpy as np
import OpenEXR


def main():
    heights = np.load(sys.argv[1])
    seconds = []
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "heights.exr")
        for _ in range(int(sys.argv[2])):
            start = time.process_time()
            header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
            OpenEXR.File(header, {"Y": heights}).write(path)
            seconds.append(time.process_time() - start)
        size = os.path.getsize(path)
    print(json.dumps({"seconds": seconds, "bytes": size}))


main()
