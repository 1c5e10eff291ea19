#!/usr/bin/python3
"""On a terminal `photile help` goes through the program in PAGER.

    pager_test.py PHOTILE
"""

import os
import pty
import sys

for pager, expected, code in (("sed s/^/page:/", b"page:# Guide\r\n", 0), ("", b"# Guide\r\n", 0),
                              ("no-such-pager", b"PAGER: cannot start 'no-such-pager'", 1)):
    os.environ["PAGER"], printed = pager, []
    status = pty.spawn([sys.argv[1], "help", "guide"], lambda file: printed.append(os.read(file, 4096)) or printed[-1])
    found = b"".join(printed)
    if expected not in found or os.waitstatus_to_exitcode(status) != code:
        sys.exit(f"pager_test.py: error: with PAGER='{pager}' {found!r} and code {status >> 8}")
