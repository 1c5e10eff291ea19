"""Where a line of code can be made wrong by one operator, bound, constant or truth value."""

import dataclasses
import re

OPERATORS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+",
             "*": "/", "/": "*", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "%": "/", "&": "|", "|": "&", "<<": ">>", ">>": "<<", "!": "", "min": "max", "max": "min",
             "true": "false", "false": "true"}
SITES = re.compile(
    # Between blanks: no template, no pointer, no sign.
    r"(?<=[\w)\]] )(?:<<|>>|<=|>=|==|!=|&&|\|\||[+\-*/]=|[<>+\-*/%&|])(?= )"
    r"|(?<=[\s(])!(?=[\w(])"
    r"|\b(?:min|max)(?=\()|\b(?:true|false)\b"
    r"|(?<![\w.'])\d+\.\d+(?:e[+-]?\d+)?f?\b|(?<![\w.'])\d+(?![\w.'])")


@dataclasses.dataclass(frozen=True)
class Site:
    file: str    # of the repository
    line: int    # from 0
    column: int  # from 0
    token: str

    @property
    def name(self):
        return f"{self.file}:{self.line + 1}:{self.column + 1} {self.token} -> {changed(self.token)}"

    def apply(self, text):
        """The file's text with this mutant."""
        lines = text.split("\n")
        line = lines[self.line]
        assert line[self.column:].startswith(self.token), self.name
        lines[self.line] = line[:self.column] + changed(self.token) + line[self.column + len(self.token):]
        return "\n".join(lines)


def changed(token):
    if token in OPERATORS:
        return OPERATORS[token]
    if token.isdigit():
        return str(int(token) + 1)
    number = float(token.rstrip("f"))
    return f"{1.1 * number or 0.1:.9g}" + ("f" if token.endswith("f") else "")


def code_lines(text):
    """(number, line) of those that hold code: no comments, directives, texts or checks of the compiler."""
    in_comment = False
    for number, line in enumerate(text.splitlines()):
        bare = line.strip()
        if in_comment or bare.startswith(("//", "#", "/*")) or '"' in line or "static_assert" in line:
            in_comment = (in_comment or bare.startswith("/*")) and "*/" not in bare
            continue
        if "template <" in line or "throw " in line or "assert(" in line:
            continue
        yield number, line.split("//")[0]


def sites(root, files):
    """Every mutant that there is."""
    for file in files:
        name = str(file.relative_to(root))
        for number, code in code_lines(file.read_text(encoding="utf-8")):
            for found in SITES.finditer(code):
                yield Site(name, number, found.start(), found.group())
