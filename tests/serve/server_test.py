#!/usr/bin/env python3
"""What `photile serve` lets in, and when it ends.

Usage: server_test.py attacks|ends PHOTILE SOURCE_FOLDER
"""

import pathlib
import signal
import socket
import sys
import tempfile
import time

from served import Page, Served, write_hall

QUICK = ["--quality", "draft", "--photons", "20k", "-q"]
VIEW = {"eye": [2, 1.5, 3.5], "forward": [0, -0.6, -0.8], "angle": 1, "width": 64, "height": 48}


def check(what, found, expected):
    print(f"{what}: {found}", flush=True)
    assert found == expected, (what, found, expected)


def refused(served):
    port, token = served.port, served.path.strip("/")
    status, headers, page = served.request()
    check("the page", status, 200)
    assert b"connect-src 'self'" in page and b"default-src 'none'" in page
    assert headers["X-Frame-Options"] == "DENY" and headers["Cache-Control"] == "no-store"
    # Neither the address without its token, nor a part of that, nor a file.
    for path in ("/", "/events", f"/{'0' * 32}/", f"/{token[:-1]}/", f"/{token}", f"//{token}/", f"/{token}/%2e%2e/",
                 f"/{token}/../../../../etc/passwd", f"/{token}/etc/passwd", "/" + "a" * 9000, "*"):
        status = served.request(path=path)[0]
        print(f"GET {path[:60]}: {status}", flush=True)
        assert status in (400, 404, 414), (path, status)
    # A name that points to this machine may belong to anybody.
    check("another host", served.request(host=f"evil.example:{port}")[0], 403)
    check("a host that looks like a number", served.request(host=f"127.0.0.1.evil.example:{port}")[0], 403)
    check("no host", served.request(host=" ")[0], 403)
    for host in (f"localhost:{port}", "localhost:9000", f"[::1]:{port}"):  # as tunnels have them
        check(f"by {host}", served.request(host=host)[0], 200)
    check("another origin", served.request("events?viewer=a", Origin="http://evil.example")[0], 403)
    check("another port", served.request("light?since=0", Origin=f"http://127.0.0.1:{port + 1}")[0], 403)
    check("another method", served.request(method="DELETE")[0], 405)


def posts(served):
    page = Page(served, "a")
    page.hear("work")
    check("a post", served.post("view", "a", VIEW), 200)
    check("without origin", served.post("view", "a", VIEW, Origin=None), 403)
    check("from elsewhere", served.post("view", "a", VIEW, Origin="http://evil.example"), 403)
    check("as a form", served.post("view", "a", VIEW, Content_Type="text/plain"), 415)
    check("in chunks", served.post("view", "a", b"0\r\n\r\n", Transfer_Encoding="chunked"), 411)
    check("packed", served.post("view", "a", VIEW, Content_Encoding="gzip"), 411)
    check("by nobody", served.post("view", "b", VIEW), 404)
    check("of nothing", served.post("nothing", "a", {}), 404)
    check("too long", served.post("lamps", "a", b"{}", Content_Length=10 ** 9), 413)
    for what, body in (("no JSON", b"view"), ("no object", b"[]"), ("deep", b"[" * 100000), ("empty", b"{}"),
                       ("a huge picture", {**VIEW, "width": 10 ** 9}), ("no direction", {**VIEW, "forward": [0, 0, 0]}),
                       ("words", {**VIEW, "eye": ["a", 0, 0]}), ("another sky", {**VIEW, "sky": [1, 2, 3]}),
                       ("more", {**VIEW, "file": "/etc/passwd"})):
        check(what, served.post("view", "a", body), 400)
    point = {"number": 1, "place": [0, 0, 0], "normal": [0, 1, 0]}
    for what, damage in (("a damaged point", {"normal": [9, 0, 0]}), ("one without a number", {"number": None}),
                         ("one of a negative number", {"number": -1})):
        check(what, served.post("point", "a", {**point, **damage}), 400)
    sent = [served.post("point", "a", {**point, "number": number}) for number in range(1, 102)]
    check("too many points", (sent[:99].count(200), sent[99:]), (99, [400, 400]))
    check("one in place of another", served.post("point", "a", {**point, "number": 5}), 200)
    check("one less", served.post("point", "a", {"number": 7}), 200)
    check("one more", served.post("point", "a", {**point, "number": 200}), 200)
    check("a mood without a name", served.post("moods", "a", {"keep": ""}), 400)
    page.close()


def waits(served):
    """Half requests hold up nobody for long."""
    half = [served.connect() for _ in range(100)]
    for connection in half:
        connection.sendall(b"GET / HTTP/1.1\r\nHost: ")
    began = time.monotonic()
    check("the page beside a hundred half requests", served.request()[0], 200)
    print(f"after {time.monotonic() - began:.1f} s")
    assert time.monotonic() - began < 10
    half[0].settimeout(15)
    while half[0].recv(4096):
        pass
    for connection in half:
        connection.close()


def shared(served):
    """Two viewers have the same lamps, each his own eye and point."""
    first, second = Page(served, "first"), Page(served, "second")
    first.hear("work")
    second.hear("work")
    lamps = {"lights": {"left": [12, 1, 2700]}}
    check("lamps", served.post("lamps", "first", lamps), 200)
    check("the other's lamps", second.hear("lamps"), lamps)
    third = Page(served, "third")
    check("those of who comes later", third.hear("lamps"), lamps)
    for viewer, width in (("first", 64), ("second", 48)):
        served.post("view", viewer, {**VIEW, "width": width})
    for page, viewer, width in ((first, "first", 64), (second, "second", 48)):
        page.hear("picture")
        picture = served.request(f"picture?viewer={viewer}")[2]
        assert f'"width":{width}'.encode() in picture[:300], picture[:300]
    check("nobody's picture", served.request("picture?viewer=third")[0], 404)
    for number, place in ((4, [2, 0, 3]), (9, [3, 0, 3])):
        check("a point", served.post("point", "first", {"number": number, "place": place, "normal": [0, 1, 0]}), 200)
    known = {4: [], 9: []}
    while any(len(repeats) < 3 for repeats in known.values()):
        for point in first.hear("points"):
            check("told so far", point["from"], len(known[point["number"]]))
            known[point["number"]] += point["repeats"]
    assert known[4] != known[9]
    light = served.request("light?since=0")[2]
    size = int(light[:8], 16)
    assert light[8:9] == b"{" and len(light) > 8 + size + 100
    for page in (first, second, third):
        page.close()


def test_attacks(folder):
    with Served(PHOTILE, write_hall(folder), *QUICK) as served:
        other = socket.socket()
        other.settimeout(5)
        assert other.connect_ex(("127.0.0.2", served.port)) != 0, "it listens beyond 127.0.0.1"
        refused(served)
        posts(served)
        waits(served)
        shared(served)
        assert served.process.poll() is None
    with Served(PHOTILE, write_hall(folder), *QUICK) as again:
        assert again.path != served.path, "the token is always the same"


def test_ends(folder):
    scene = write_hall(folder)
    with Served(PHOTILE, scene, *QUICK) as served:
        pages = [Page(served, name) for name in ("a", "b")]
        pages[0].hear("work")
        served.post("view", "a", VIEW)
        began = time.monotonic()
        served.process.send_signal(signal.SIGINT)
        check("by Ctrl-C", served.process.wait(20), 130)
        print(f"after {time.monotonic() - began:.2f} s")
        assert time.monotonic() - began < 3
    with Served(PHOTILE, scene, "--keep", "2s", *QUICK) as served:
        time.sleep(3)
        assert served.process.poll() is None, "before a page was there"
        first, second = Page(served, "a"), Page(served, "b")
        second.hear("work")
        first.close()
        time.sleep(4)
        assert served.process.poll() is None, "another page is open"
        second.close()
        check("after the last page", served.process.wait(20), 0)


if __name__ == "__main__":
    PHOTILE = sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        globals()[f"test_{sys.argv[1]}"](pathlib.Path(name))
