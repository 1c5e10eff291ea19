#!/usr/bin/python3
"""What tests/docs/figures.py refuses."""

import hashlib
import json
import pathlib
import subprocess
import tempfile
import unittest

import figures

FIGURE = {"values": [52.4, 55.1], "command": "photile render", "machine": "any", "commit": "0" * 40,
          "date": "2020-01-02", "measures": ["host"]}
README = "# photile\n\n## Three figures\n\n- It takes {} processor seconds.\n\n## License\n\n99 words.\n"


class Figures(unittest.TestCase):
    def setUp(self):
        self.source = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.source / "docs").mkdir()
        self.write({"room.s": FIGURE}, "52 to 55<!-- figure: room.s -->")

    def write(self, of_names, text):
        (self.source / "docs/figures.json").write_text(json.dumps(of_names))
        (self.source / "README.md").write_text(README.format(text))

    def test_what_agrees_passes(self):
        for text in ("52 to 55", "52.4 and 55.1", "with k = 50, at 512x512, 52 to 55"):
            self.write({"room.s": FIGURE}, f"{text}<!-- figure: room.s -->")
            self.assertEqual(figures.check(self.source), [], text)

    def test_another_number_and_one_without_a_figure_are_refused(self):
        other = "room.s, which is 52.4 and 55.1"
        for text, more, told in (("41 to 55", "", other), ("52 to 56", "", other), ("52.3 to 55.1", "", other),
                                 ("55", "", other), ("52 to 55", " or 41", "41 is no figure")):
            self.write({"room.s": FIGURE}, f"{text}<!-- figure: room.s -->{more}")
            self.assertIn(told, figures.check(self.source)[0])

    def test_a_figure_that_is_not_there_is_refused(self):
        (self.source / "docs/page.md").write_text("It takes 3<!-- figure: other.s --> s.\n")
        self.assertEqual(figures.check(self.source), ["docs/page.md: there is no figure other.s"])

    def test_an_old_figure_is_refused(self):
        self.commits(figures.OLDEST + 3)
        self.assertIn("201 commits older", figures.check(self.source)[0])  # found by its date
        first = self.git("rev-list", "--max-parents=0", "HEAD")
        self.write({"room.s": {**FIGURE, "commit": first, "date": "2030-01-01"}}, "52 to 55<!-- figure: room.s -->")
        self.assertIn("202 commits older", figures.check(self.source)[0])
        later = self.git("rev-list", "--max-count=1", "--skip=5", "HEAD")
        self.write({"room.s": {**FIGURE, "commit": later}}, "52 to 55<!-- figure: room.s -->")
        self.assertEqual(figures.check(self.source), [])
        self.write({"room.s": {**FIGURE, "measures": ["kernels"]}}, "52 to 55<!-- figure: room.s -->")
        self.assertEqual(figures.check(self.source), [])

    def write_block(self, text, **record):
        (self.source / "docs/page.md").write_text(f"# A page\n\n<!-- begin: bench/a.py -->\n\n{text}\n<!-- end -->\n")
        record = {**FIGURE, "sha256": hashlib.sha256(b"| 1 s |").hexdigest(), **record}
        (self.source / "docs/blocks.json").write_text(json.dumps({"page.md: a.py": record}))

    def test_a_block_passes_as_it_was_recorded_and_not_edited_by_hand(self):
        self.write_block("| 1 s |")
        self.assertEqual(figures.check(self.source), [])
        self.write_block("| 2 s |")
        self.assertIn("change the script, not the block", figures.check(self.source)[0])

    def test_a_block_without_a_record_and_a_record_without_a_block_are_refused(self):
        self.write_block("| 1 s |")
        (self.source / "docs/page.md").rename(self.source / "docs/other.md")
        missing, left = figures.check(self.source)
        self.assertIn("other.md: a.py has written a block that docs/blocks.json does not record", missing)
        self.assertIn("page.md: a.py is recorded, but the page has no such block", left)

    def test_a_table_of_numbers_by_hand_is_refused(self):
        table = "| | s | error |\n|---|--:|--:|\n| room | 1.5 | **2%** |\n\n"
        page = self.source / "docs/page.md"
        page.write_text(f"# A page\n\n{table}")
        self.assertEqual(figures.check(self.source),
                         ["docs/page.md: the table | | s | error | is of numbers, and no script wrote it"])
        page.write_text(f"# A page\n\n<!-- not measured -->\n\n{table}| name | value |\n|---|---|\n| k | 50 |\n")
        self.assertEqual(figures.check(self.source), [])

    def test_an_old_block_is_refused(self):
        self.write_block("| 1 s |")
        self.commits(figures.OLDEST + 3)
        self.assertIn("docs/page.md: a.py is 201 commits older", " ".join(figures.check(self.source)))

    def test_a_block_of_a_card_states_dates_and_does_not_become_old(self):
        self.write({}, "nothing")
        self.commits(figures.OLDEST + 3)
        for date, wrong in ((" 2020-01-02 |", 0), ("", 1)):
            text = f"| k | s |\n|---|--:|\n| 50 | 1 |{date}"
            self.write_block(text, card="a card", sha256=hashlib.sha256(text.encode()).hexdigest())
            self.assertEqual(len(figures.check(self.source)), wrong)

    def test_a_shallow_clone_says_nothing_of_ages(self):
        self.write_block("| 1 s |")
        self.commits(figures.OLDEST + 3)
        self.git("add", "-A")
        self.git("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "pages")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["git", "clone", "-q", "--depth=3", f"file://{self.source}", folder], check=True)
            self.assertEqual(figures.check(pathlib.Path(folder)), [])

    def git(self, *arguments, **more):
        return subprocess.run(["git", "-C", self.source, *arguments], check=True, capture_output=True, text=True,
                              **more).stdout.strip()

    def commits(self, count):
        """A day apart from 1 January 2020 on; each changes a file of `host`."""
        self.git("init", "-q", "-b", "main")
        text = ""
        for number in range(count):
            seconds = 1577880000 + 86400 * number
            text += (f"commit refs/heads/main\ncommitter a <a@b> {seconds} +0000\ndata 1\nx\n"
                     f"M 100644 inline host/file\ndata {len(str(number))}\n{number}\n\n")
        self.git("fast-import", "--quiet", input=text)


if __name__ == "__main__":
    unittest.main()
