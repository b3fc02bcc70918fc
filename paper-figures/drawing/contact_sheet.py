"""All pictures on one sheet, small enough for the documentation."""

import io
import os

WIDTH, COLUMNS, GAP, LABEL = 2000, 4, 14, 22
MOST_BYTES = 2_000_000


def contact_sheet(pictures, path):
    """Writes a PNG with the pictures, at least one, scaled to columns of equal width."""
    from PIL import Image, ImageDraw, ImageFont

    column = (WIDTH - (COLUMNS + 1) * GAP) // COLUMNS
    font = ImageFont.truetype("DejaVuSans.ttf", 13)
    placed, heights = [], [GAP] * COLUMNS
    for picture in pictures:
        image = Image.open(picture).convert("RGB")
        image = image.resize((column, max(1, round(image.height * column / image.width))), Image.LANCZOS)
        k = min(range(COLUMNS), key=lambda c: heights[c])
        placed.append((image, GAP + k * (column + GAP), heights[k], picture.stem))
        heights[k] += image.height + LABEL + GAP
    sheet = Image.new("RGB", (WIDTH, max(heights)), "white")
    draw = ImageDraw.Draw(sheet)
    for image, x, y, name in placed:
        draw.text((x, y), name, fill="#14181c", font=font)
        sheet.paste(image, (x, y + LABEL))
    for colors in (256, 128, 64):  # a palette saves more than half, and small pictures do not show it
        buffer = io.BytesIO()
        sheet.quantize(colors, dither=Image.Dither.NONE).save(buffer, "PNG", optimize=True)
        if buffer.tell() <= MOST_BYTES:
            break
    part = path.with_name(f".{path.name}.{os.getpid()}")
    part.write_bytes(buffer.getvalue())
    os.replace(part, path)
