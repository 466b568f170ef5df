"""Writes the programs of a README into files, addressed to another server.

    readme_blocks.py README.md LANGUAGE URL FOLDER ENDING
"""

import pathlib
import re
import sys


def main(readme, language, url, folder, ending):
    text = pathlib.Path(readme).read_text(encoding="utf-8")
    blocks = re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    if not blocks:
        sys.exit(f"{readme} has no block of {language}")
    for number, block in enumerate(blocks, 1):
        if "http://127.0.0.1:8080" not in block:
            sys.exit(f"block {number} of {readme} does not name the server")
        program = pathlib.Path(folder, f"readme_{number}.{ending}")
        program.write_text(block.replace("http://127.0.0.1:8080", url), encoding="utf-8")


main(*sys.argv[1:])
