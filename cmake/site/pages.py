"""What mkdocs needs to know of docs/: the order of its pages, and links as GitHub has them."""

import pathlib
import re

SHELVES = ("guide", "kernels", "method", "reference", "measured", "decisions")
SHOWN = {".md", ".png", ".svg", ".webp", ".html"}
LINK = re.compile(r"(!?)\[([^\]]*)\]\(\s*([^)\s]+)\s*\)")


def anchor(title, separator):
    """GitHub's name of a heading."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", separator)


def linked_pages(index):
    """The pages of a folder in the order in which its README.md names them."""
    targets = (match[3].partition("#")[0] for match in LINK.finditer(index.read_text(encoding="utf-8")))
    return list(dict.fromkeys(target for target in targets
                              if target.endswith(".md") and "/" not in target and target != "README.md"))


def on_config(config):
    docs = pathlib.Path(config["docs_dir"])
    config["mdx_configs"].setdefault("toc", {})["slugify"] = anchor
    config["nav"] = ["README.md"] + [
        {shelf.capitalize(): [f"{shelf}/{page}" for page in ("README.md", *linked_pages(docs / shelf / "README.md"))]}
        for shelf in SHELVES]
    return config


def on_files(files, config):
    """Records and examples stay in the repository; the pages name them."""
    docs = pathlib.Path(config["docs_dir"])
    for file in list(files):
        path = pathlib.PurePath(file.src_uri)
        if (docs / path).is_file() and (path.suffix not in SHOWN or path.parts[0] == "examples"):
            files.remove(file)
    return files


def on_page_markdown(markdown, page, config, files):
    """Links to what is no page or picture become the names of files in the repository."""
    source = pathlib.Path(config["docs_dir"]).parent

    def shown(match):
        path = match[3].partition("#")[0]
        if match[1] or not path or re.match(r"\w+:", path):
            return match[0]
        target = (pathlib.Path(page.file.abs_src_path).parent / path).resolve()
        if target.is_file() and files.get_file_from_path(target.relative_to(source / "docs").as_posix()
                                                         if target.is_relative_to(source / "docs") else "-"):
            return match[0]
        name = target.relative_to(source) if target.is_relative_to(source) else path
        return f"`{name}`" if match[2].strip("`/") in str(name) else f"{match[2]} (`{name}`)"

    return LINK.sub(shown, markdown)


def on_page_content(html, page, config, files):
    """Bars of code in tables, which GitHub has escaped."""
    return re.sub(r"<td.*?</td>", lambda cell: cell[0].replace("\\|", "|"), html, flags=re.DOTALL)
