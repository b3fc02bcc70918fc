#!/usr/bin/python3
"""Tests of the animated picture: test_render_hold.py RENDER_HOLD_PY PAGES [--keep-pictures FOLDER].

PAGES holds what write_sample_pages wrote; a replay's page has the scene that the script reads.
"""

import json

from picture_test import PictureTest, main  # It comes first, as it says what is missing.

from PIL import Image, ImageChops


def share_near(image, color, tolerance=45):
    """Returns the share of the pixels whose channels all are within `tolerance` of `color`."""
    distances = ImageChops.difference(image, Image.new("RGB", image.size, color)).split()
    largest = ImageChops.lighter(ImageChops.lighter(distances[0], distances[1]), distances[2])
    return sum(largest.histogram()[: tolerance + 1]) / (image.width * image.height)


class RenderHold(PictureTest):
    page = "replay.html"

    def test_shows_the_hand_closing_and_the_load_pulling_the_ball_away(self):
        file = self.drawn("replay.gif", "--width", "320", "--height", "310")
        with Image.open(file) as image:
            # The ball passes 50 mm at 0.56 s, and 0.2 s more are shown: a frame every 0.04 s, but
            # no farther than the frames that the scene has (0.72 s).
            self.assertEqual(image.n_frames, 19)
            frames = []
            for i in range(image.n_frames):
                image.seek(i)
                frames.append(image.convert("RGB"))
        view = (0, 40, 320, 210)
        ball = [share_near(frame.crop(view), (200, 190, 175)) for frame in frames]
        red = [share_near(frame.crop(view), (211, 48, 41)) for frame in frames]
        self.assertGreater(ball[0], 0.05)
        self.assertLess(ball[-1], 0.5 * ball[0], "the ball has left the view")
        self.assertLess(max(red[:11]), 1e-3, "no arrow before the load")
        self.assertGreater(red[12], 2e-3, "the load's arrow")
        self.assertIsNotNone(ImageChops.difference(frames[0], frames[5]).getbbox(), "the hand closes")

    def test_a_table_is_shown_where_there_is_one(self):
        def share():
            with Image.open(self.drawn("replay.gif", "--width", "320", "--height", "310")) as image:
                view = image.convert("RGB").crop((0, 40, 320, 210))
                return share_near(view, (166, 187, 159), 30)

        without = share()
        self.text = json.dumps(json.loads(self.text) | {"table_z": -0.04})
        self.assertGreater(share(), without + 0.05)

    def test_bad_input_is_one_line_and_no_file(self):
        scene = json.loads(self.text)
        scene["directions"][0]["times"].pop()
        for text, flags, says in (
            ("{", (), "not the scene"),
            ("{}", (), "not the scene"),
            (json.dumps(scene), (), "does not fit its times"),
            (self.text, ("--load", "up"), "no load named up; there are +x, -x, +y"),
        ):
            self.assert_refused(text, "replay.gif", flags, says)


if __name__ == "__main__":
    main()
