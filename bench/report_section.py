"""The part of a page of docs/ that a script writes, between two comments."""

END = "<!-- end -->\n"


def replace_section(page, script, text):
    """Puts `text` between `<!-- begin: bench/SCRIPT -->` and `<!-- end -->` of the file `page`."""
    begin = f"<!-- begin: bench/{script} -->\n"
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + "\n" + text + "\n" + END + rest.split(END, 1)[1])
