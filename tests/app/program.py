"""Runs the program graspfit and builds the small meshes that its tests need."""

import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["GRASPFIT"]
SOURCE_DIR = pathlib.Path(os.environ["GRASPFIT_SOURCE_DIR"])


def cache_of_tests():
    """Returns a folder below GRASPFIT_TEST_CACHE for one build of the program: its tests leave
    nothing in the cache of whoever runs them, but share what takes long (convex pieces of a hand)."""
    folder = pathlib.Path(os.environ["GRASPFIT_TEST_CACHE"])
    own = folder / str(os.stat(PROGRAM).st_mtime_ns)
    for older in folder.glob("*"):
        if older != own:
            shutil.rmtree(older, ignore_errors=True)
    own.mkdir(parents=True, exist_ok=True)
    return own


os.environ["GRASPFIT_CACHE"] = str(cache_of_tests())


def run(*arguments, cwd=None, env=None):
    """Returns exit code, standard output and standard error of one run."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd,
                          env=env, check=False)


def off_text(vertices, faces):
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(repr(float(x)) for x in vertex) for vertex in vertices]
    lines += [f"{len(face)} " + " ".join(map(str, face)) for face in faces]
    return "\n".join(lines) + "\n"


def torus(major=0.05, minor=0.02, rings=32, sides=16):
    """Returns a closed outward torus around z [m], which a Barrett hand grasps easily."""
    vertices = []
    for i in range(rings):
        for j in range(sides):
            u, v = 2 * math.pi * i / rings, 2 * math.pi * j / sides
            radius = major + minor * math.cos(v)
            vertices.append((radius * math.cos(u), radius * math.sin(u), minor * math.sin(v)))
    faces = []
    for i in range(rings):
        for j in range(sides):
            a, b = i * sides + j, (i + 1) % rings * sides + j
            c, d = (i + 1) % rings * sides + (j + 1) % sides, i * sides + (j + 1) % sides
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def box(x, y, z):
    """Returns a closed outward box around the origin, of 12 triangles [m]."""
    vertices = [(sx * x / 2, sy * y / 2, sz * z / 2)
                for sz in (-1, 1) for sy in (-1, 1) for sx in (-1, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]


def german_environment(folder):
    """Returns an environment with a locale whose decimals have a comma: the system's, or one
    compiled into `folder`."""
    done = subprocess.run(["locale", "-a"], capture_output=True, text=True, check=False)
    german = [name for name in done.stdout.split() if name.startswith("de_")]
    if german:
        return {**os.environ, "LC_ALL": german[0]}
    if shutil.which("localedef"):
        locale = folder / "de_DE.UTF-8"
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", locale],
                       capture_output=True, check=False)
        if locale.is_dir():
            return {**os.environ, "LOCPATH": str(folder), "LC_ALL": locale.name}
    return None


class ProgramTest(unittest.TestCase):
    """A test that has a temporary folder of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text) if isinstance(text, str) else path.write_bytes(text)
        return path

    def write_torus(self, name="torus.off"):
        return self.write(name, off_text(*torus()))

    def contents(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))

    def assert_refused(self, *arguments, code=2, says=(), cwd=None):
        """Checks for one line on standard error, nothing on standard output, and no new file."""
        before = self.contents()
        done = run(*arguments, cwd=cwd)
        shown = f"graspfit {' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}"
        self.assertEqual(done.returncode, code, shown)
        self.assertEqual(len(done.stderr.splitlines()), 1, shown)
        self.assertTrue(done.stderr.startswith("graspfit"), shown)
        self.assertEqual(done.stdout, "", shown)
        self.assertEqual(self.contents(), before, shown)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr, shown)
        return done.stderr


def main():
    """Runs the test classes named on the command line, or all of the file.

    The word "SKIPPED: " makes ctest count the whole test as skipped, whether or not something
    failed. It is printed only where nothing ran.
    """
    outcome = unittest.main(verbosity=2, exit=False).result
    word = "SKIPPED" if outcome.testsRun <= len(outcome.skipped) else "SKIPPED in part"
    for _, reason in outcome.skipped:
        print(f"{word}: {reason}")
    sys.exit(not outcome.wasSuccessful())
