"""The commands that the pages show run as they stand there."""

import os
import pathlib
import re
import shlex
import shutil

import program
from program import SOURCE_DIR

CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
PACKAGED_MESHES = pathlib.Path(os.environ.get("GRASPFIT_PACKAGED_MESHES", CACHE / "graspfit/meshes"))

# These commands take long, change the repository or need what a test has not; beside each stands
# what runs the like.
ELSEWHERE = (
    r"\./(quickstart|run-tests)\b",                        # .ci/run, setup/bare-root
    r"cmake --(preset release|install build/release) ",    # .ci/run, tests/repository
    r"paper-figures/make\b",                               # tests/paper_figures
    r"graspfit (hand|shape|plan) .*\b(claw|ball)\b",       # test_own_hand.py
    r"graspfit (shape|plan|evaluate) .*(\bbin|_bin)\b",     # test_table.py
    r"graspfit experiment run .* --(jobs|shard|publish)",  # test_experiment.py: shards, columns
    r"graspfit experiment run .* --(set|object) ",         # test_experiment_data.py: own objects
    r"graspfit (experiment run .* --config|dataset) ",      # test_dataset.py
    r"graspfit experiment (merge|status|verify) ",         # test_experiment.py: shards
    r'graspfit hold "results/hold_rates/',                 # test_hold.py: --grasp, --step
)


def pages():
    """Returns the pages of the repository."""
    return [*SOURCE_DIR.glob("*.md"), *SOURCE_DIR.glob("docs/*.md"),
            *SOURCE_DIR.glob("*/README.md"), *SOURCE_DIR.glob("grasp/*/README.md")]


def commands_of(page):
    """Returns the commands in the blocks of a page, without prompts and remarks."""
    text = page.read_text(encoding="utf-8")
    for language, block in re.findall(r"(?ms)^```(\w*)\n(.*?)^```$", text):
        for line in block.splitlines():
            line = line.removeprefix("$ ") if language == "console" else line
            if language == "sh" or line.startswith("graspfit "):
                words = re.split(r"\s+#|\s{3,}", line)[0].strip()
                if words and not words.startswith("#"):
                    yield words


def is_elsewhere(command):
    return any(re.match(pattern, command) for pattern in ELSEWHERE)


class Pages(program.ProgramTest):
    def setUp(self):
        super().setUp()
        if not (PACKAGED_MESHES / "bunny00.off").is_file():
            self.skipTest("no packaged meshes; set GRASPFIT_PACKAGED_MESHES")
        shutil.copy(PACKAGED_MESHES / "bunny00.off", self.folder)

    def run_line(self, line):
        """Runs a line of commands joined by &&. Returns the standard output of the last."""
        text = ""
        for command in line.split("&&"):
            words = shlex.split(command)
            self.assertEqual(words[0], "graspfit", line)
            done = program.run(*words[1:], cwd=self.folder)
            missing = "hold" in words and "MuJoCo" in done.stderr
            self.assertTrue(done.returncode == 0 or missing, f"{line}\n{done.stderr}")
            text = done.stdout
        return text

    def test_every_command_in_a_block_of_a_page_runs_here_or_elsewhere(self):
        # The pages run in their order: what README.md plans is converted by a later page.
        readme = SOURCE_DIR / "README.md"
        exchange = SOURCE_DIR / "grasp/exchange/README.md"
        rest = [page for page in pages() if page not in (readme, exchange)]
        num_run = num_elsewhere = 0
        for page in [readme, exchange, *rest]:
            for command in commands_of(page):
                if is_elsewhere(command):
                    num_elsewhere += 1
                    continue
                with self.subTest(f"{page.relative_to(SOURCE_DIR)}: {command}"):
                    self.run_line(command)
                    num_run += 1
                    # Somebody else's files are written, which the next commands need.
                    for ending in (".yaml", ".npz"):
                        if command.endswith(f" bunny{ending}"):
                            shutil.copy(self.folder / f"bunny{ending}",
                                        self.folder / f"theirs{ending}")
        self.assertGreaterEqual(num_run, 10)
        self.assertGreaterEqual(num_elsewhere, 15)

    def test_readme_shows_what_its_command_prints_and_its_further_commands_run(self):
        text = (SOURCE_DIR / "README.md").read_text(encoding="utf-8")
        (block,) = re.findall(r"(?ms)^```console\n\$ (.*?)^```$", text)
        command, _, shown = block.partition("\n")
        shown, printed = shown.splitlines(), self.run_line(command).splitlines()
        # Another processor may round sines otherwise, and the search then takes another way.
        self.assertEqual(printed[0], shown[0])
        self.assertEqual(len(printed), len(shown))
        self.assertEqual(printed[-1], shown[-1])
        for lines in (printed, shown):
            self.assertTrue(any(re.match(r"5 of 5 grasps, (all|4) closed, in \d+ attempts "
                                         r"\(stopped at the wanted number\): valid \d+", line)
                                for line in lines), lines)
        further = re.findall(r"(?m)^\| `(graspfit [^`]*)` \|", text)
        self.assertGreaterEqual(len(further), 5)
        for line in further:
            with self.subTest(line):
                self.run_line(line)

    def test_commands_in_the_text_are_commands_with_flags_that_there_are(self):
        helps = {}
        for page in pages():
            if page.name == "CHANGELOG.md":
                continue  # It only says what there was.
            for line in re.findall(r"`graspfit ([^`\n]*)`", page.read_text(encoding="utf-8")):
                words = line.split()
                size = 2 if words[0] in ("dataset", "experiment", "hand") and len(words) > 1 else 1
                name = tuple(words[:size])
                if any(word.isupper() or word.startswith("-") for word in name):
                    continue  # It stands for any command.
                if name not in helps:
                    done = program.run(*name, "--help-all")
                    self.assertEqual(done.returncode, 0, f"{page.name}: {line}")
                    helps[name] = set(re.findall(r"--[a-z][a-z0-9-]*", done.stdout))
                flags = set(re.findall(r"--[a-z][a-z0-9-]*", line))
                self.assertLessEqual(flags, helps[name] | {"--help", "--help-all"},
                                     f"{page.name}: {line}")
        self.assertGreater(len(helps), 10)


if __name__ == "__main__":
    program.main()
