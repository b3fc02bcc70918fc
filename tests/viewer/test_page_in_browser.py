#!/usr/bin/python3
"""Opens sample pages in headless Chromium: test_page_in_browser.py FOLDER [--keep-pictures FOLDER].

FOLDER holds what write_sample_pages wrote. No test needs a network, and a page that asked for one would
be refused by its own security policy and so fail for its console message.
"""

import io
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

PACKAGES = "apt-get install chromium chromium-driver python3-selenium python3-pil"
# The driver is on this machine.
os.environ["NO_PROXY"] = os.environ["no_proxy"] = "localhost,127.0.0.1"

try:
    from PIL import Image, ImageChops
    from selenium import webdriver
    from selenium.common.exceptions import SessionNotCreatedException
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.utils import is_connectable
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError as error:
    print(f"SKIPPED: {error}; {PACKAGES}")
    sys.exit(0)

PAGES = None
PICTURES = None


class LoopbackService(Service):
    """Finds the driver by address: a bare system may have no /etc/hosts, and then no
    "localhost"."""

    @property
    def service_url(self):
        return f"http://127.0.0.1:{self.port}"

    def is_connectable(self):
        return is_connectable(self.port, "127.0.0.1")


def start_browser(chromium, chromedriver, profile):
    options = Options()
    options.binary_location = chromium
    for flag in (
        "--headless=new",
        "--no-sandbox",  # Tests may run as root in a container.
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",  # WebGL works without a graphics card then.
        "--enable-unsafe-swiftshader",
        "--ignore-gpu-blocklist",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--remote-debugging-pipe",  # Otherwise the driver, too, looks for "localhost".
        "--no-first-run",
        "--no-proxy-server",
        "--force-device-scale-factor=1",
        "--window-size=900,640",
        f"--user-data-dir={profile}",
    ):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=LoopbackService(chromedriver), options=options)


class PageInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.profile, cls.browser = cls.started()
        cls.browser.set_script_timeout(30)

    @classmethod
    def started(cls):
        """Returns a browser with a profile of its own. On a busy machine its first start may
        time out, and a second is tried."""
        for is_last in (False, True):
            profile = tempfile.TemporaryDirectory(prefix="graspfit_browser_", ignore_cleanup_errors=True)
            try:
                return profile, start_browser(CHROMIUM, CHROMEDRIVER, profile.name)
            except SessionNotCreatedException:
                profile.cleanup()
                if is_last:
                    raise

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.profile.cleanup()

    def open(self, name):
        self.browser.get((PAGES / name).resolve().as_uri())
        self.settle()

    def tearDown(self):
        messages = [entry["message"] for entry in self.browser.get_log("browser")]
        self.assertEqual(messages, [], "messages in the console")

    def settle(self):
        """Waits until what was asked for is drawn: the page draws in the next animation frame."""
        self.browser.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(done));"
        )

    def element(self, name):
        return self.browser.find_element(By.ID, name)

    def picture(self, name=None):
        """Returns what WebGL drew. Text above it is hidden, as browsers smooth it differently
        from time to time."""
        if PICTURES and name:
            self.settle()
            self.browser.save_screenshot(str(PICTURES / f"{name}.png"))
        self.show_text_on_scene(False)
        image = Image.open(io.BytesIO(self.element("scene").screenshot_as_png)).convert("RGB")
        self.show_text_on_scene(True)
        return image

    def show_text_on_scene(self, is_shown):
        """Shows or hides text on the scene. Once text is hidden, what was asked for before is drawn.

        It is one call, as calls take most of the time.
        """
        self.browser.execute_async_script(
            "const [is_shown, done] = arguments;"
            "for (const element of document.querySelectorAll('#stage > :not(canvas):not(#message)'))"
            "  element.style.visibility = is_shown ? '' : 'hidden';"
            "if (is_shown) done(); else requestAnimationFrame(() => requestAnimationFrame(done));",
            is_shown,
        )

    def text(self, name):
        return self.element(name).text

    @staticmethod
    def share_near(image, color, tolerance=40):
        """Returns the share of the pixels whose channels all are within `tolerance` of `color`."""
        distances = ImageChops.difference(image, Image.new("RGB", image.size, color)).split()
        largest = ImageChops.lighter(ImageChops.lighter(distances[0], distances[1]), distances[2])
        return sum(largest.histogram()[: tolerance + 1]) / (image.width * image.height)

    def assert_differs(self, a, b, what):
        self.assertIsNotNone(ImageChops.difference(a, b).getbbox(), what)

    def assert_same(self, a, b, what):
        self.assertIsNone(ImageChops.difference(a, b).getbbox(), what)


class GraspsInBrowser(PageInBrowser):
    """Tests of the page of grasps."""

    def test_scene_is_drawn(self):
        # This page has no surroundings either, which would shrink the rest.
        self.open("without_model.html")
        image = self.picture("page")
        background = self.share_near(image, (0xF4, 0xF5, 0xF4), 2)
        self.assertLess(background, 0.9)
        self.assertGreater(background, 0.2)
        self.assertGreater(self.share_near(image, (0xC4, 0xBB, 0xAC)), 0.02, "object's color")
        self.assertGreater(self.share_near(image, (0x6A, 0x88, 0xA5)), 0.02, "hand's color")
        self.assertFalse(self.element("message").is_displayed())

    def test_title_and_list(self):
        self.open("ball.html")
        self.assertEqual(self.browser.title, "Ball <40 mm> & three fingers")
        self.assertEqual(self.browser.find_element(By.TAG_NAME, "h1").text, self.browser.title)
        self.assertIn("3 grasps, 2 usable, 1 valid", self.text("summary"))
        self.assertIn("80 × 80 × 80 mm", self.text("summary"))
        # The rows are in the order of the file.
        rows = self.browser.find_elements(By.CSS_SELECTOR, "#list > div")
        self.assertEqual([row.get_attribute("id") for row in rows], ["grasp-1", "grasp-2", "grasp-3"])
        badges = [row.find_element(By.CLASS_NAME, "badge").text for row in rows]
        self.assertEqual(badges, ["valid", "usable", "unusable"])
        for part in ("M 0.600", "M1 0.600", "M2 1.000", "M3 1.000"):
            self.assertIn(part, rows[1].text)
        self.assertEqual(rows[0].get_attribute("aria-selected"), "true")

    def test_click_and_arrow_keys_select(self):
        self.open("ball.html")
        before = self.picture()
        self.assertEqual(self.text("m"), "M 0.4000")
        self.assertIn("none", self.text("penetration"))
        self.element("grasp-2").click()
        self.assertEqual(self.text("m"), "M 0.6000")
        self.assertIn("4.70 to 4.90 mm", self.text("penetration"))
        self.assert_differs(before, self.picture("usable"), "another grasp, the same picture")
        self.element("grasp-3").click()
        self.assertEqual(self.text("m"), "M 0.0000")
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#contacts tbody tr")), 2)
        selected = self.browser.find_elements(By.CSS_SELECTOR, '#list [aria-selected="true"]')
        self.assertEqual([row.get_attribute("id") for row in selected], ["grasp-3"])

        self.element("grasp-1").click()
        body = self.browser.find_element(By.TAG_NAME, "body")
        shown = []
        for key in (Keys.ARROW_DOWN, Keys.ARROW_DOWN, Keys.ARROW_DOWN, Keys.ARROW_UP):
            body.send_keys(key)
            shown.append(self.text("m"))
        self.assertEqual(shown, ["M 0.6000", "M 0.0000", "M 0.0000", "M 0.6000"])

    def test_every_measure_is_shown(self):
        self.open("ball.html")
        self.element("grasp-1").click()
        contacts = [row.text for row in self.browser.find_elements(By.CSS_SELECTOR, "#contacts tbody tr")]
        # The columns are finger, gap [mm], area [mm²], d [mm] and S of
        # tests/viewer/sample_scene.cpp.
        self.assertEqual(contacts, ["1 thumb 0.000 40.0 8.00 1", "2 finger_1 0.200 50.0 8.50 1",
                                    "3 finger_2 0.400 60.0 9.00 1"])
        measures = self.text("measures")
        for part in ("M1 sustainability", "0.4000", "R regularity", "D centroid distance", "0.00 mm",
                     "M of the targets", "0.7000", "ε", "force closure", "0.1234"):
            self.assertIn(part, measures)
        self.assertNotIn("no force closure", measures)
        self.assertEqual(self.text("pairs").count("30.0°"), 3)
        for summary in self.browser.find_elements(By.TAG_NAME, "summary"):
            summary.click()
        self.assertIn("joint_3", self.text("right"))
        self.assertIn("Attempt", self.text("right"))

    def test_closure_that_only_rounding_makes_is_none(self):
        self.open("ball.html")
        self.element("grasp-2").click()
        self.assertIn("no force closure", self.text("measures"))

    def test_pre_grasp_grasp_and_squeeze_pose_the_hand(self):
        self.open("ball.html")
        self.element("grasp-1").click()
        pressed = lambda name: self.element(f"configuration-{name}").get_attribute("aria-pressed")
        plain = self.picture()
        self.assertEqual(pressed("grasp"), "true")
        joints = self.browser.find_element(By.CSS_SELECTOR, "#right details")
        joints.find_element(By.TAG_NAME, "summary").click()
        pictures = {}
        for name, angle in (("pre_grasp", "-22.9 °"), ("squeeze", "5.7 °"), ("grasp", "0.0 °")):
            self.element(f"configuration-{name}").click()
            self.assertEqual(pressed(name), "true")
            pictures[name] = self.picture(f"configuration_{name}")
            joints = self.browser.find_element(By.CSS_SELECTOR, "#right details")
            self.assertIn(f"joint_1 {angle}", joints.text.replace("\n", " "))
        self.assert_differs(pictures["pre_grasp"], pictures["grasp"], "pre-grasp")
        self.assert_differs(pictures["squeeze"], pictures["grasp"], "squeeze")
        self.assert_same(plain, pictures["grasp"], "back at the grasp, another picture")
        for part in ("Pre-grasp clearance", "6.5 mm", "30.0 mm", "balanced", "1.2 %"):
            self.assertIn(part, self.text("ways"))

        # A grasp without pre-grasp and squeeze shows itself, and its buttons are off.
        self.element("configuration-pre_grasp").click()
        self.assertIn("shown in its pre-grasp", self.text("shown"))
        self.element("grasp-2").click()
        self.assertFalse(self.element("configuration-pre_grasp").is_enabled())
        self.assertEqual(pressed("grasp"), "true")

    def test_table_and_obstacles_are_drawn_where_there_are_any(self):
        self.open("ball.html")
        with_table = self.picture("surroundings")
        self.element("show-surroundings").click()
        self.assertGreater(self.share_near(with_table, (188, 196, 186), 12),
                           10 * self.share_near(self.picture(), (188, 196, 186), 12))
        self.assertIn("Hand and surroundings\ntable and obstacles\nnone".replace("\n", " "),
                      self.text("penetration").replace("\n", " "))
        self.open("without_model.html")
        self.assertEqual(self.browser.find_elements(By.ID, "show-surroundings"), [])

    def test_toggles_change_the_picture_and_back(self):
        self.open("ball.html")
        self.element("grasp-1").click()
        plain = self.picture()
        for layer in ("object", "hand", "contacts", "polygon", "palm", "center", "targets", "clips",
                      "voxels", "scores", "surroundings"):
            with self.subTest(layer=layer):
                box = self.element(f"show-{layer}")
                box.click()
                self.assert_differs(plain, self.picture(layer), f"{layer} toggled, the same picture")
                box.click()
        self.assert_same(plain, self.picture(), "all toggled twice, another picture")

    def test_scores_color_the_object_and_the_voxels(self):
        self.open("ball.html")
        # Of the layers that are hidden here the obstacles have nearly the object's color.
        for layer in ("hand", "contacts", "polygon", "palm", "center", "surroundings"):
            self.element(f"show-{layer}").click()
        beige = self.share_near(self.picture(), (0xC4, 0xBB, 0xAC))
        self.element("show-scores").click()
        self.assertLess(self.share_near(self.picture("score_map"), (0xC4, 0xBB, 0xAC)), 0.2 * beige)
        self.element("show-voxels").click()
        self.assertLess(self.share_near(self.picture("score_voxels"), (0xC4, 0xBB, 0xAC)), 0.2 * beige)

    def test_mouse_rotates_pans_and_zooms(self):
        self.open("ball.html")
        canvas = self.element("scene")
        start = self.picture()
        ActionChains(self.browser).drag_and_drop_by_offset(canvas, 90, 40).perform()
        rotated = self.picture("rotated")
        self.assert_differs(start, rotated, "dragged")
        ActionChains(self.browser).key_down(Keys.SHIFT).drag_and_drop_by_offset(
            canvas, 60, 0).key_up(Keys.SHIFT).perform()
        panned = self.picture()
        self.assert_differs(rotated, panned, "shift and drag")
        self.browser.execute_script(
            "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -240, cancelable: true}))", canvas)
        self.assert_differs(panned, self.picture(), "wheel")
        # Fit keeps the direction, so that twice is the same as once.
        fit = self.browser.find_element(By.CSS_SELECTOR, '[data-view="fit"]')
        fit.click()
        fitted = self.picture()
        fit.click()
        self.assert_same(fitted, self.picture(), "Fit twice")
        for view in ("side", "front", "behind", "polygon"):
            before = self.picture()
            self.browser.find_element(By.CSS_SELECTOR, f'[data-view="{view}"]').click()
            self.assert_differs(before, self.picture(f"view_{view}"), view)

    def test_page_without_voxels(self):
        self.open("without_model.html")
        for layer in ("voxels", "scores"):
            self.assertFalse(self.element(f"show-{layer}").is_enabled())
        self.assertLess(self.share_near(self.picture(), (0xF4, 0xF5, 0xF4), 2), 0.9)

    def test_page_without_grasps(self):
        self.open("no_grasps.html")
        self.assertIn("No grasp was found", self.text("right"))
        self.browser.find_element(By.TAG_NAME, "body").send_keys(Keys.ARROW_DOWN)
        self.assertGreater(self.share_near(self.picture("no_grasps"), (0xC4, 0xBB, 0xAC)), 0.05)

    def test_narrow_window(self):
        self.browser.set_window_size(600, 640)
        try:
            self.open("ball.html")
            self.assertLess(self.share_near(self.picture("narrow"), (0xF4, 0xF5, 0xF4), 2), 0.95)
            width = self.browser.execute_script("return document.documentElement.scrollWidth")
            self.assertLessEqual(width, self.browser.execute_script("return innerWidth"))
        finally:
            self.browser.set_window_size(900, 640)


class HandInBrowser(PageInBrowser):
    """Tests of the page of a hand: tests/viewer/sample_scene.cpp, sample_hand_scene."""

    def setUp(self):
        self.open("hand.html")
        text = self.browser.execute_script("return document.getElementById('data').textContent")
        self.scene = json.loads(text)

    def tips(self):
        """Returns the positions of the tip pads [mm] as the page shows them."""
        rows = self.browser.find_elements(By.CSS_SELECTOR, "#tips tbody tr")
        cells = [[cell.text for cell in row.find_elements(By.TAG_NAME, "td")] for row in rows]
        return {name: [float(x) for x in point] for name, *point, _ in cells}

    def expected_tips(self, pose):
        """Returns the same from the link poses that forward kinematics in C++ gave."""
        hand = self.scene["hand"]
        tips = {}
        for finger in hand["fingers"]:
            pad = hand["pads"][finger["tip_pad"]]
            X = pose["X_HL"][pad["link"]]
            p = pad["X_LC"][12:15]
            tips[finger["name"]] = [
                1000 * (sum(X[4 * k + i] * p[k] for k in range(3)) + X[12 + i]) for i in range(3)
            ]
        return tips

    def assert_tips(self, expected):
        shown = self.tips()
        self.assertEqual(shown.keys(), expected.keys())
        for name, point in expected.items():
            for a, b in zip(shown[name], point):
                self.assertAlmostEqual(a, b, delta=0.00501)  # Two digits are shown.

    def move(self, joint, value):
        self.browser.execute_script(
            "const slider = document.getElementById(arguments[0]);"
            "slider.value = arguments[1]; slider.dispatchEvent(new Event('input'));",
            f"joint-{joint}",
            value,
        )

    def test_hand_is_drawn_with_its_title(self):
        image = self.picture("hand")
        self.assertEqual(self.browser.title, "sample")
        self.assertIn("A sentence with <signs> & marks.", self.text("summary"))
        self.assertIn("3 fingers · 3 joints, 1 independent · 3 pads", self.text("summary"))
        # The sample's third finger slides 0.3 m away, so that the hand fills little of the view.
        self.assertLess(self.share_near(image, (0xF4, 0xF5, 0xF4), 2), 0.995)
        self.assertFalse(self.element("message").is_displayed())

    def test_poses_put_links_where_forward_kinematics_does(self):
        pictures = []
        for i, pose in enumerate(self.scene["poses"]):
            self.element(f"pose-{i}").click()
            self.assert_tips(self.expected_tips(pose))
            self.assertEqual(self.element(f"pose-{i}").get_attribute("aria-pressed"), "true")
            pictures.append(self.picture(f"hand_{pose['name']}"))
        self.assert_differs(*pictures, "another pose, the same picture")

    def test_slider_moves_followers_and_comes_back_to_the_pose(self):
        open_pose, closed_pose = self.scene["poses"]
        self.element("pose-0").click()
        before = self.picture()
        self.move(0, closed_pose["q"][0])
        self.assert_tips(self.expected_tips(closed_pose))
        self.assertEqual(self.element("pose-1").get_attribute("aria-pressed"), "false")
        self.move(0, open_pose["q"][0])
        self.assert_tips(self.expected_tips(open_pose))
        self.assert_same(before, self.picture(), "moved there and back")

    def test_follower_is_fixed_unless_it_may_break_away(self):
        self.assertTrue(self.element("joint-0").is_enabled())
        self.assertFalse(self.element("joint-1").is_enabled())
        self.assertTrue(self.element("joint-2").is_enabled())
        self.element("pose-0").click()
        coupled = self.scene["poses"][0]["q"][2]
        self.move(2, 0.5)  # It is further closed, and stays.
        self.assertEqual(self.text("value-2"), "500.0 mm")
        self.move(2, -0.8)  # It is less closed than its leader asks for, and does not stay.
        self.assertEqual(self.text("value-2"), f"{1000 * coupled:.1f} mm")

    def test_layers_and_views_change_the_picture(self):
        plain = self.picture()
        for layer in ("hand", "joints", "palm", "pads", "clips"):
            with self.subTest(layer=layer):
                box = self.element(f"show-{layer}")
                box.click()
                self.assert_differs(plain, self.picture(layer), f"{layer} toggled, the same picture")
                box.click()
        self.assert_same(plain, self.picture(), "all toggled twice, another picture")
        for view in ("side", "front", "behind", "oblique"):
            before = self.picture()
            self.browser.find_element(By.CSS_SELECTOR, f'[data-view="{view}"]').click()
            self.assert_differs(before, self.picture(f"hand_{view}"), view)


class ReplayInBrowser(PageInBrowser):
    """Tests of the page of a hold test: tests/viewer/sample_replay.cpp."""

    def setUp(self):
        self.open("replay.html")

    def set_time(self, frame):
        self.browser.execute_script(
            "const slider = document.getElementById('time');"
            "slider.value = arguments[0]; slider.dispatchEvent(new Event('input'));",
            frame,
        )

    def test_starts_with_the_load_that_failed_and_says_why(self):
        self.assertEqual(self.browser.title, "Ball <40 mm>, grasp 1")
        self.assertIn("sample · 2 of 3 loads held", self.text("summary"))
        selected = self.browser.find_elements(By.CSS_SELECTOR, '#list [aria-selected="true"]')
        self.assertEqual([row.get_attribute("id") for row in selected], ["direction-2"])
        badges = [row.text for row in self.browser.find_elements(By.CSS_SELECTOR, "#list .badge")]
        self.assertEqual(badges, ["held", "held", "lost under load"])
        self.assertIn("lost under load", self.text("verdict"))
        self.assertIn("12.5 N", self.text("verdict"))
        # It reaches 2.5 t² = 50 mm at 0.141 s; the next of the frames is 0.16 s after the load
        # began.
        story = self.text("story")
        for part in ("along +y with 1.00 N", "check after 0.2 s", "100.0 mm", "passed 50 mm after 0.16 s"):
            self.assertIn(part, story)
        self.element("jump").click()
        self.assertEqual(self.text("clock"), "0.56 s")
        self.assertIn("64.0 mm", self.text("value-shift"))
        self.assertIn("9.2 °", self.text("value-turn"))

    def test_axis_labels_stay_at_their_axes_while_the_window_grows(self):
        # Observers are called in the order in which they were made, the page's first: this one
        # finds what is painted next.
        canvas, stage, tops = self.browser.execute_async_script(
            "const done = arguments[0];"
            "const stage = document.getElementById('stage'), canvas = document.getElementById('scene');"
            "const tops = () => [...document.querySelectorAll('#labels .axis')].map("
            "    (label) => label.getBoundingClientRect().top - stage.getBoundingClientRect().bottom);"
            "const before = tops();"
            "let calls = 0;"
            "new ResizeObserver(() => {"
            "  if (++calls === 1) { stage.style.height = `${stage.clientHeight + 150}px`; return; }"
            "  done([canvas.height, canvas.clientHeight, tops().map((top, i) => top - before[i])]);"
            "}).observe(stage);"
        )
        self.assertEqual(canvas, stage)  # One pixel is one of the picture.
        self.assertEqual(len(tops), 3)
        for moved in tops:  # These are distances from the lower edge, where the axes are.
            self.assertLess(abs(moved), 0.2)

    def test_slider_moves_hand_and_object_and_back(self):
        self.set_time(0)
        self.assertIn("closing", self.text("phase"))
        start = self.picture("replay_start")
        self.set_time(20)
        self.assertEqual(self.text("clock"), "0.40 s")
        self.assertIn("squeezing", self.text("phase"))
        squeezed = self.picture("replay_squeezed")
        self.assert_differs(start, squeezed, "the hand closed")
        self.element("show-load").click()
        self.assert_same(squeezed, self.picture(), "no load yet, no arrow")
        self.element("show-load").click()
        self.set_time(27)
        self.assertIn("under load", self.text("phase"))
        loaded = self.picture("replay_loaded")
        self.assert_differs(squeezed, loaded, "the ball moved")
        self.set_time(20)
        self.assert_same(squeezed, self.picture(), "there and back")

    def test_loads_are_chosen_by_click_and_keys(self):
        body = self.browser.find_element(By.TAG_NAME, "body")
        body.send_keys(Keys.ARROW_UP)
        self.assertIn("Held: pulled along -x", self.text("story"))
        self.assertFalse(self.element("jump").is_enabled())
        body.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(self.text("clock"), "0.42 s")
        self.element("direction-0").click()
        self.assertIn("Held: pulled along +x", self.text("story"))
        self.assertIn("1.0 mm", self.text("story"))
        self.assertEqual(self.text("clock"), "0.40 s")

    def test_plays_to_the_end_and_pauses(self):
        self.browser.execute_script(
            "const speed = document.getElementById('speed');"
            "speed.value = '1'; speed.dispatchEvent(new Event('change'));")
        clock = lambda: float(self.text("clock").removesuffix(" s"))
        self.element("play").click()
        WebDriverWait(self.browser, 60).until(lambda _: self.text("play") == "Play")
        end = int(self.element("time").get_attribute("max"))
        self.assertEqual(int(self.element("time").get_property("value")), end)
        # From the end it starts anew, and it stands still when paused.
        self.browser.execute_script(
            "const play = document.getElementById('play'); play.click(); play.click();")
        self.assertEqual(self.text("play"), "Play")
        paused = clock()
        self.assertLess(paused, 0.4)
        self.settle()
        self.assertEqual(clock(), paused)

    def test_layers_and_views_change_the_picture(self):
        self.set_time(25)
        plain = self.picture("replay")
        for layer in ("object", "hand", "load", "path", "pieces"):
            with self.subTest(layer=layer):
                box = self.element(f"show-{layer}")
                box.click()
                self.assert_differs(plain, self.picture(f"replay_{layer}"), f"{layer} toggled, the same picture")
                box.click()
        self.assert_same(plain, self.picture(), "all toggled twice, another picture")
        for view in ("x", "y", "z", "side"):
            before = self.picture()
            self.browser.find_element(By.CSS_SELECTOR, f'[data-view="{view}"]').click()
            self.assert_differs(before, self.picture(f"replay_view_{view}"), view)

    def test_protocol_is_listed(self):
        self.browser.find_element(By.CSS_SELECTOR, "#right summary").click()
        self.assertIn("force_N 1", self.text("parameters"))
        self.assertIn("check_interval_s 0.1", self.text("parameters"))


class MotionInBrowser(PageInBrowser):
    """Tests of the page of a hand that moves objects: tests/viewer/sample_motion.cpp."""

    def setUp(self):
        self.open("motion.html")

    def selected(self):
        rows = self.browser.find_elements(By.CSS_SELECTOR, '#list [aria-selected="true"]')
        return [row.get_attribute("id") for row in rows]

    def test_says_what_moves_and_what_does_not(self):
        self.assertEqual(self.browser.title, "Two moves & a <flat> box")
        self.assertIn("2 moves · 2 of 3 objects at their goals", self.text("summary"))
        self.assertIn("was not checked", self.text("story"))
        self.assertNotIn("proven", self.text("story"))
        self.assertIn("flat <box>: it is too flat", self.browser.find_element(By.ID, "right").text)
        self.assertIn("1. ball: reach", self.text("phase"))

    def test_slider_and_moves_change_the_picture_and_back(self):
        start = self.picture("motion_start")
        body = self.browser.find_element(By.TAG_NAME, "body")
        self.element("move-1").click()
        self.assertEqual(self.selected(), ["move-1"])
        self.assertIn("2. red block: reach", self.text("phase"))
        self.assert_differs(start, self.picture("motion_second"), "the ball has moved")
        body.send_keys(Keys.ARROW_UP)
        self.assertEqual(self.selected(), ["move-0"])
        self.assert_same(start, self.picture(), "there and back")
        self.browser.execute_script(
            "const slider = document.getElementById('time');"
            "slider.value = slider.max; slider.dispatchEvent(new Event('input'));")
        self.assertIn("2. red block: retreat", self.text("phase"))
        self.assert_differs(start, self.picture("motion_end"), "both have moved")

    def test_layers_and_views_change_the_picture(self):
        self.browser.execute_script(
            "const slider = document.getElementById('time');"
            "slider.value = Math.round(slider.max / 3); slider.dispatchEvent(new Event('input'));")
        plain = self.picture("motion")
        for layer in ("objects", "hand", "table", "path"):
            with self.subTest(layer=layer):
                box = self.element(f"show-{layer}")
                box.click()
                self.assert_differs(plain, self.picture(f"motion_{layer}"), f"{layer} toggled, the same picture")
                box.click()
        self.assert_same(plain, self.picture(), "all toggled twice, another picture")
        for view in ("left", "right", "above", "front"):
            before = self.picture()
            self.browser.find_element(By.CSS_SELECTOR, f'[data-view="{view}"]').click()
            self.assert_differs(before, self.picture(f"motion_view_{view}"), view)

    def test_plays_on_and_pauses(self):
        self.element("play").click()
        WebDriverWait(self.browser, 60).until(
            lambda _: int(self.element("time").get_property("value")) > 3)
        self.element("play").click()
        self.assertEqual(self.text("play"), "Play")


if __name__ == "__main__":
    CHROMIUM = shutil.which("chromium")
    CHROMEDRIVER = shutil.which("chromedriver")
    if not CHROMIUM or not CHROMEDRIVER:
        print(f"SKIPPED: no chromium with chromedriver; {PACKAGES}")
        sys.exit(0)
    PAGES = pathlib.Path(sys.argv.pop(1))
    if "--keep-pictures" in sys.argv:
        at = sys.argv.index("--keep-pictures")
        PICTURES = pathlib.Path(sys.argv[at + 1])
        PICTURES.mkdir(parents=True, exist_ok=True)
        del sys.argv[at : at + 2]
    unittest.main(verbosity=2)
