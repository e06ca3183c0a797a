#!/usr/bin/env python3
"""Draws a recording in the real Rerun viewer, off screen, as the README shows it.

    picture.py RECORDING.rrd OUT.png

Needs rerun-sdk of the version in Cargo.toml, pillow, and a Vulkan driver (a software one will do).
"""
import pathlib
import socket
import sys
import time

import rerun as rr
from PIL import Image
from rerun.experimental import ViewerClient

WIDTH = 1280


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def main():
    recording, out = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    port = free_port()
    viewer = str(pathlib.Path(sys.executable).parent / "rerun")
    out.unlink(missing_ok=True)
    with ViewerClient.spawn(headless=True, port=port, executable_path=viewer) as client:
        loader = rr.RecordingStream("loader")
        loader.connect_grpc(f"rerun+http://127.0.0.1:{port}/proxy")
        loader.log_file_from_path(recording)
        loader.flush()
        time.sleep(8)
        client.save_screenshot(str(out))
        deadline = time.time() + 30
        while not out.exists() and time.time() < deadline:
            time.sleep(0.5)
        time.sleep(1)
    picture = Image.open(out).convert("RGB")
    picture = picture.resize((WIDTH, WIDTH * picture.height // picture.width), Image.Resampling.LANCZOS)
    picture.save(out, optimize=True)
    print(f"{out}: {out.stat().st_size} bytes")


main()
