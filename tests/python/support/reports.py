"""Making reports in tests, and taking their pages apart."""

import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser

from oitlab_analysis.write.report import make_report
from program import ROOT


def run(*arguments):
    """The command as the C++ program runs it."""
    environment = os.environ | {"PYTHONPATH": str(ROOT / "analysis")}
    return subprocess.run([sys.executable, "-m", "oitlab_analysis", *map(str, arguments)],
                          env=environment, capture_output=True, text=True, timeout=120)


def html_of(folder):
    make_report([folder])
    return (folder / "report.html").read_text(encoding="utf-8")


def embedded_pictures(html):
    data = re.search(r'<script type="application/json" id="picture-data">(.*?)</script>', html, re.S)
    return json.loads(data[1])


class Page(HTMLParser):
    """What a test needs of a page: its resources, its tables and whether its tags match."""

    VOID = frozenset({"meta", "img", "br", "link", "input"})

    def __init__(self, text):
        super().__init__()
        self.open, self.sources, self.links, self.text = [], [], [], text
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.sources += [attributes[key] for key in ("src", "srcset") if key in attributes]
        self.links += [attributes["href"]] if "href" in attributes else []
        assert tag != "img" or attributes["alt"]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def tables(self):
        """The rows of each section's table."""
        found = re.findall(r'<script type="application/json" class="rows">(.*?)</script>', self.text, re.S)
        return [json.loads(text) for text in found]
