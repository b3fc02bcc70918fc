"""What the scripts that draw motions share: poses of a scene's JSON, animated pictures.

Poses are x, y, z and a unit quaternion w, x, y, z.
"""

import io

from scene_file import numbers
from vtk_picture import BadInput, cross


def decode_poses(text):
    values = numbers(text, "f")
    return [values[i : i + 7] for i in range(0, len(values), 7)]


def rotated(pose, v):
    w, q = pose[3], pose[4:7]
    t = [2.0 * x for x in cross(q, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(q, t))]


def mapped(pose, p):
    return [a + b for a, b in zip(rotated(pose, p), pose[:3])]


def put(vtk, actor, pose):
    """Puts an actor where a pose says."""
    matrix = vtk.vtkMatrix4x4()
    for column in range(3):
        axis = rotated(pose, [float(k == column) for k in range(3)])
        for row in range(3):
            matrix.SetElement(row, column, axis[row])
    for row in range(3):
        matrix.SetElement(row, 3, pose[row])
    actor.SetUserMatrix(matrix)


def decoded_pictures(files):
    """Pictures of PNG files given as bytes."""
    try:
        from PIL import Image
    except ImportError as error:
        raise BadInput(f"{error}: install python3-pil") from error
    return [Image.open(io.BytesIO(file)).convert("RGB") for file in files]


def gif(files, delay, last_delay, num_samples=4):
    """GIF file as bytes, from PNG files as bytes; delays in milliseconds.

    One palette for all frames, so that colors do not flicker: that of some frames from start to end.
    """
    pictures = decoded_pictures(files)
    from PIL import Image

    width, height = pictures[0].size
    sample = pictures[:: max(1, len(pictures) // num_samples)]
    sheet = Image.new("RGB", (width, height * len(sample)))
    for i, picture in enumerate(sample):
        sheet.paste(picture, (0, i * height))
    palette = sheet.quantize(256, dither=Image.Dither.NONE)
    pictures = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    delays = [delay] * (len(pictures) - 1) + [last_delay]
    file = io.BytesIO()
    pictures[0].save(
        file, "GIF", save_all=True, append_images=pictures[1:], duration=delays, loop=0
    )
    return file.getvalue()
