#!/usr/bin/python3
"""Tests of a motion's pictures: test_render_motion.py RENDER_MOTION_PY PAGES [--keep-pictures FOLDER].

PAGES holds what write_sample_pages wrote; a motion's page has the scene that the script reads.
"""

import json

from picture_test import PictureTest, main  # It comes first, as it says what is missing.

from PIL import Image, ImageChops


class RenderMotion(PictureTest):
    page = "motion.html"

    def test_plays_every_move(self):
        file = self.drawn("motion.gif", "--width", "320", "--height", "240")
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
        file = self.drawn("motion.png", "--width", "300", "--height", "220")
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
            self.assert_refused(text, name, (), says)


if __name__ == "__main__":
    main()
