#!/usr/bin/env python3
"""Makes docs/gallery.md and its pictures: runs every shipped scene and draws its recording as it opens.

    gallery.py PROGRAM [SCENE...]      PROGRAM is a built torquescope; without scenes, all of them

Needs what tests/interop/picture.py needs.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "gallery"
WIDTH = 900


def draw(program, scene):
    with tempfile.TemporaryDirectory() as folder:
        recording = pathlib.Path(folder) / f"{scene.stem}.rrd"
        subprocess.run([program, "run", scene, "--out", recording], check=True, stdout=subprocess.DEVNULL)
        picture = PICTURES / f"{scene.stem}.png"
        maker = ROOT / "tests" / "interop" / "picture.py"
        subprocess.run([sys.executable, maker, recording, picture], check=True)
    image = Image.open(picture)
    image = image.resize((WIDTH, WIDTH * image.height // image.width), Image.Resampling.LANCZOS)
    # By octree: it keeps the few pixels that arrows have.
    image.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(picture, optimize=True)


def entry(scene):
    text = scene.read_text()
    comment = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comment.append(line[1:].strip())
    paragraphs = re.split(r"\n\s*\n", "\n".join(comment))
    title = tomllib.loads(text)["title"]
    return (
        f"## {title}\n\n"
        f"`torquescope run @{scene.stem}`, [the scene](../scenes/{scene.name})\n\n"
        f"![{title}, as its recording opens](gallery/{scene.stem}.png)\n\n"
        + "\n\n".join(paragraphs[1:])
        + "\n"
    )


def main():
    program, chosen = sys.argv[1], set(sys.argv[2:])
    scenes = sorted((ROOT / "scenes").glob("*.toml"))
    PICTURES.mkdir(exist_ok=True)
    for scene in scenes:
        if not chosen or scene.stem in chosen:
            draw(program, scene)
    head = (
        "# Gallery\n\n"
        "Every scene that the program carries, as its recording opens: `torquescope run @NAME --view`. What each claims is\n"
        "checked in the tests (`tests/gallery.rs`, `tests/scenes.rs`). This page is made by `docs/gallery.py`.\n\n"
    )
    (ROOT / "docs" / "gallery.md").write_text(head + "\n".join(entry(scene) for scene in scenes))


main()
