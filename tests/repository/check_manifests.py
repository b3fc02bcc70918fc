"""Checks that no published manifest holds a path of the machine that made it.

Every text in a manifest is searched, keys included, for an absolute path, a home folder or an
option --out. The strings at the end of this file show what is found and what is not.
"""

import json
import pathlib
import re
import sys

# It finds a slash that begins a word, or follows what cannot stand in a relative path, and a name
# after it; a tilde's folder; a drive letter; and an option that names a folder of results.
MACHINE_PATH = re.compile(r"(?:^|[\s'\"=:,;(])(?:/|~/|~\w+/|file:/+|[A-Za-z]:\\)[\w.-]|--out\b")

FOUND = ["/tmp/out", "graspfit experiment run x --out results", "a '/home/me/x y'", "~/results",
         "GRASPFIT_DATA=/data", "file:///etc", "C:\\data", "run x --out=../y"]
NOT_FOUND = ["meshes/paper/bunny.off", "N m/rad", "1 / 2", "shard 1/3", "Linux 6.1 x86_64",
             "graspfit experiment run force_closure --jobs 2 --publish", "a: b/c", "--outline"]


def texts_of(value):
    if isinstance(value, dict):
        for key, member in value.items():
            yield key
            yield from texts_of(member)
    elif isinstance(value, list):
        for item in value:
            yield from texts_of(item)
    elif isinstance(value, str):
        yield value


def main(folder):
    wrong = [f"misses {text!r}" for text in FOUND if not MACHINE_PATH.search(text)]
    wrong += [f"takes {text!r} for a path" for text in NOT_FOUND if MACHINE_PATH.search(text)]
    manifests = sorted(pathlib.Path(folder).glob("*.manifest.json"))
    if not manifests:
        wrong.append(f"{folder}: no manifests")
    for manifest in manifests:
        wrong += [f"{manifest.name}: {text!r}"
                  for text in texts_of(json.loads(manifest.read_text(encoding="utf-8")))
                  if MACHINE_PATH.search(text)]
    print("\n".join(wrong) or f"{len(manifests)} manifests without a path of a machine")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
