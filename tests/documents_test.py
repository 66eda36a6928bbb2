#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The pages of documentation: the first one is short and lists its contents, and what pages link to or name exists."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MOST_LINES = 150  # of the first page
LINK = re.compile(r"\]\(([^)\s]+)\)")
# Files of the project in code marks: `tests/README.md`. Others are made by a command, or the reader's.
NAMED = re.compile(r"`((?:filter_neuralmesh|packaging|screenshots|tests|vcg_core)/[\w./-]+)`")
CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


def pages(root):
    return sorted([root / "README.md", *root.glob("vcg_core/*.md"), *root.glob("tests/**/*.md"),
                   *root.glob("filter_neuralmesh/**/*.md")])


def anchor_of(heading):
    """What GitHub calls a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def broken(root):
    """One sentence for each link that leads nowhere, and each file named that does not exist."""
    for page in pages(root):
        text = CODE.sub("", page.read_text(encoding="utf-8"))
        where = page.relative_to(root)
        for link in LINK.findall(text):
            if re.match(r"\w+:", link):
                continue
            name, _, anchor = link.partition("#")
            target = page.parent / name if name else page
            if not target.exists():
                yield f"{where}: the link {link} leads nowhere."
            elif anchor and anchor not in map(anchor_of, HEADING.findall(target.read_text(encoding="utf-8"))):
                yield f"{where}: {link} is no heading."
        for name in NAMED.findall(text):
            if not any((folder / name).exists() for folder in (root, page.parent)):
                yield f"{where}: there is no {name}."


class Documents(unittest.TestCase):
    def test_links_and_names_lead_somewhere(self):
        found = list(broken(ROOT))
        self.assertFalse(found, "\n" + "\n".join(found))

    def test_the_first_page_is_short(self):
        self.assertLessEqual(len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()), MOST_LINES)

    def test_the_first_page_lists_its_contents_and_all_pages(self):
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        links = LINK.findall(text)
        self.assertEqual([link[1:] for link in links if link.startswith("#")],
                         [anchor_of(heading) for heading in re.findall(r"^###? (.+)$", CODE.sub("", text), re.MULTILINE)])
        for page in ROOT.glob("filter_neuralmesh/docs/*.md"):
            self.assertIn(str(page.relative_to(ROOT)), links)


if __name__ == "__main__":
    sys.exit(unittest.main())
