"""The tests of pictures share this: a page of write_sample_pages has the scene that a script
draws.

A test's file is called as TEST.py SCRIPT_PY PAGES [--keep-pictures FOLDER].
"""

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
    import PIL  # noqa: F401
except ImportError as error:
    print(f"SKIPPED: {error}; {PACKAGES}")
    sys.exit(0)


class PictureTest(unittest.TestCase):
    page = None  # file name of the page that has the scene
    script = None
    pages = None
    pictures = None  # folder to keep pictures in

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        html = (self.pages / self.page).read_text()
        self.text = html.split('<script type="application/json" id="data">')[1].split("</script>")[0]

    def draw(self, text, name, *flags):
        scene = self.folder / "scene.json"
        scene.write_text(text)
        return subprocess.run(
            [sys.executable, "-B", self.script, str(scene), str(self.folder / name), *flags],
            capture_output=True, text=True, timeout=500, check=False)

    def drawn(self, name, *flags):
        """Returns the file of a picture of the page's scene."""
        done = self.draw(self.text, name, *flags)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        if self.pictures:
            shutil.copy(self.folder / name, self.pictures)
        return self.folder / name

    def assert_refused(self, text, name, flags, says):
        with self.subTest(says=says):
            done = self.draw(text, name, *flags)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(says, done.stderr)
            self.assertFalse((self.folder / name).exists())


def main():
    if not shutil.which("xvfb-run") and not os.environ.get("DISPLAY"):
        print(f"SKIPPED: no display; {PACKAGES}")
        sys.exit(0)
    PictureTest.script = sys.argv.pop(1)
    PictureTest.pages = pathlib.Path(sys.argv.pop(1))
    if "--keep-pictures" in sys.argv:
        at = sys.argv.index("--keep-pictures")
        PictureTest.pictures = pathlib.Path(sys.argv[at + 1])
        PictureTest.pictures.mkdir(parents=True, exist_ok=True)
        del sys.argv[at : at + 2]
    unittest.main(verbosity=2)
