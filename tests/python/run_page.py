"""Runs the Python code of a page, block after block in one namespace, in a folder of its own.

A block of text right after a block of code is what the code prints. Usage: run_page.py PAGE.md
"""

import contextlib
import io
import os
import re
import sys
import tempfile


def main(page: str) -> int:
    with open(page, encoding="utf-8") as file:
        text = file.read()
    block = re.compile(r"^```python\n(?P<code>.*?)^```\n(?:\n```text\n(?P<output>.*?)^```\n)?", re.M | re.S)
    names: dict = {"__name__": "__main__"}
    blocks = list(block.finditer(text))
    if not blocks:
        print(f"{page}: there is no Python code: has the mark changed?")
        return 1
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for match in blocks:
            line = text[: match.start("code")].count("\n")
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                # The code stands at its own lines, so that an error names them.
                exec(compile("\n" * line + match["code"], page, "exec"), names)
            if match["output"] is not None and printed.getvalue() != match["output"]:
                print(f"{page}:{line}: prints\n{printed.getvalue()}and the page says\n{match['output']}")
                return 1
        os.chdir("/")
    print(f"{page}: {len(blocks)} blocks")
    return 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
