"""Scenes that graspfit writes for the picture scripts: JSON with meshes and poses as base64 of binary numbers."""

import array
import base64
import json
import sys

from vtk_picture import BadInput


def numbers(text, kind):
    """Little-endian numbers: "f" single precision, "I" unsigned 32 bits."""
    values = array.array(kind, base64.b64decode(text))
    if sys.byteorder == "big":
        values.byteswap()
    return values


def decode_mesh(mesh):
    """Vertices as x, y, z [m] and faces as three indices each, in place."""
    for key, kind in (("vertices", "f"), ("faces", "I")):
        values = numbers(mesh[key], kind)
        mesh[key] = [values[i : i + 3] for i in range(0, len(values), 3)]


def read_scene(path, kind, decode):
    """The scene in `path` after `decode`, which raises ValueError where it is not one of `kind`."""
    try:
        scene = json.loads(path.read_text(encoding="utf-8"))
        for link in scene["hand"]["links"]:
            decode_mesh(link["mesh"])
        decode(scene)
        return scene
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: not the scene of a {kind}: {error!r}") from error


def exit_code(script, work):
    """Runs `work`; 0, or 1 with one line on standard error, or 130 where it was interrupted."""
    try:
        work()
    except BadInput as error:
        print(f"{script}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0
