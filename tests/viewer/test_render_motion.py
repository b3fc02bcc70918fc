#!/usr/bin/python3
"""Tests of a motion's pictures: test_render_motion.py RENDER_MOTION_PY PAGES [--keep-pictures FOLDER].

PAGES holds what write_sample_pages wrote; a motion's page has the scene that the script reads.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PACKAGES = "apt-get install python3-vtk9 xvfb xauth python3-pil"

try:
    import vtk  # noqa: F401
    from PIL import Image, ImageChops
except ImportError as error:
    print(f"SKIPPED: {error}; {PACKAGES}")
    sys.exit(0)

SCRIPT = None
PAGES = None
PICTURES = None


class RenderMotion(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        html = (PAGES / "motion.html").read_text()
        self.text = html.split('<script type="application/json" id="data">')[1].split("</script>")[0]

    def draw(self, text, name, *flags):
        scene = self.folder / "scene.json"
        scene.write_text(text)
        return subprocess.run(
            [sys.executable, "-B", SCRIPT, str(scene), str(self.folder / name), *flags],
            capture_output=True, text=True, timeout=500, check=False)

    def test_plays_every_move(self):
        done = self.draw(self.text, "motion.gif", "--width", "320", "--height", "240")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        file = self.folder / "motion.gif"
        if PICTURES:
            shutil.copy(file, PICTURES)
        num_frames = json.loads(self.text)["num_frames"]
        with Image.open(file) as image:
            self.assertLessEqual(image.n_frames, 260)
            self.assertGreaterEqual(image.n_frames, min(num_frames, 100))
            frames = []
            for i in (0, image.n_frames // 4, image.n_frames // 2, image.n_frames - 1):
                image.seek(i)
                frames.append(image.convert("RGB"))
        for a, b in zip(frames, frames[1:]):
            self.assertIsNotNone(ImageChops.difference(a, b).getbbox(), "something moves")

    def test_sheet_has_a_row_per_move_and_a_column_per_phase(self):
        done = self.draw(self.text, "motion.png", "--width", "300", "--height", "220")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        file = self.folder / "motion.png"
        if PICTURES:
            shutil.copy(file, PICTURES)
        with Image.open(file) as image:
            self.assertEqual(image.size, (5 * 300, 2 * 220))
            cells = [
                image.convert("RGB").crop((x * 300, y * 220, (x + 1) * 300, (y + 1) * 220))
                for y in range(2)
                for x in range(5)
            ]
        for i, a in enumerate(cells):
            for b in cells[:i]:
                self.assertIsNotNone(ImageChops.difference(a, b).getbbox(), "all cells differ")

    def test_bad_input_is_one_line_and_no_file(self):
        scene = json.loads(self.text)
        scene["num_frames"] += 1
        still = json.loads(self.text)
        still["moves"] = []
        for text, name, says in (
            ("{", "motion.gif", "not the scene"),
            (json.dumps(scene), "motion.gif", "does not fit the number of frames"),
            (json.dumps(still), "motion.gif", "no move"),
            (self.text, "motion.jpg", "neither .gif nor .png"),
        ):
            with self.subTest(says=says):
                done = self.draw(text, name)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(says, done.stderr)
                self.assertFalse((self.folder / name).exists())


if __name__ == "__main__":
    if not shutil.which("xvfb-run") and not os.environ.get("DISPLAY"):
        print(f"SKIPPED: no display; {PACKAGES}")
        sys.exit(0)
    SCRIPT = sys.argv.pop(1)
    PAGES = pathlib.Path(sys.argv.pop(1))
    if "--keep-pictures" in sys.argv:
        at = sys.argv.index("--keep-pictures")
        PICTURES = pathlib.Path(sys.argv[at + 1])
        PICTURES.mkdir(parents=True, exist_ok=True)
        del sys.argv[at : at + 2]
    unittest.main(verbosity=2)
