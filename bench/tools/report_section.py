"""The part of a page of docs/ that a script writes, between two comments."""

END = "<!-- end -->\n"


def begin_of(script):
    return f"<!-- begin: bench/{script} -->\n"


def read_section(page, script):
    """What stands between the comments of `script` in the file `page`."""
    return page.read_text().split(begin_of(script))[1].split(END, 1)[0].strip("\n")


def replace_section(page, script, text):
    """Puts `text` between `<!-- begin: bench/SCRIPT -->` and `<!-- end -->` of the file `page`."""
    begin = begin_of(script)
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + "\n" + text + "\n" + END + rest.split(END, 1)[1])
