#!/usr/bin/env python3
"""What `photile view` lets in, and when it ends.

Usage: server_test.py attacks|ends|luminaires|maps|year PHOTILE SOURCE_FOLDER
"""

import json
import os
import pathlib
import re
import socket
import sys
import tempfile
import time

from served import Page, Served, room_of_gallery, write_hall

QUICK = ["--quality", "draft", "--photons", "20k", "-q"]
VIEW = {"eye": [2, 1.5, 3.5], "forward": [0, -0.6, -0.8], "angle": 1, "width": 64, "height": 48}


def check(what, found, expected):
    print(f"{what}: {found}", flush=True)
    assert found == expected, (what, found, expected)


def refused(served):
    port, token = served.port, served.path.strip("/")
    status, headers, page = served.request(Accept_Encoding="gzip, br")
    check("the page", status, 200)
    assert b"connect-src 'self'" in page and b"default-src 'none'" in page
    assert headers["X-Frame-Options"] == "DENY" and headers["Cache-Control"] == "no-store"
    assert "Content-Encoding" not in headers  # packing a page took seconds
    check("the niceness of what computes", os.getpriority(os.PRIO_PROCESS, served.process.pid), 10)
    # Neither the address without its token, nor a part of that, nor a file.
    for path in ("/", "/events", f"/{'0' * 32}/", f"/{token[:-1]}/", f"/{token}", f"//{token}/", f"/{token}/%2e%2e/",
                 f"/{token}/../../../../etc/passwd", f"/{token}/etc/passwd", "/" + "a" * 9000, "*"):
        status = served.request(path=path)[0]
        print(f"GET {path[:60]}: {status}", flush=True)
        assert status in (400, 404, 414), (path, status)
    # A name that points to this machine may belong to anybody; tunnels have other ports and localhost.
    for host, status in ((f"evil.example:{port}", 403), (f"127.0.0.1.evil.example:{port}", 403), (" ", 403),
                         (f"localhost:{port}", 200), ("localhost:9000", 200), (f"[::1]:{port}", 200)):
        check(f"by {host}", served.request(host=host)[0], status)
    check("another origin", served.request("events?viewer=a", Origin="http://evil.example")[0], 403)
    check("another port", served.request("light?since=0", Origin=f"http://127.0.0.1:{port + 1}")[0], 403)
    check("another method", served.request(method="DELETE")[0], 405)


def posts(served):
    page = Page(served, "a")
    page.hear("work")
    for what, headers, status in (
            ("a post", {}, 200), ("without origin", {"Origin": None}, 403),
            ("from elsewhere", {"Origin": "http://evil.example"}, 403),
            ("as a form", {"Content_Type": "text/plain"}, 415), ("packed", {"Content_Encoding": "gzip"}, 411)):
        check(what, served.post("view", "a", VIEW, **headers), status)
    check("in chunks", served.post("view", "a", b"0\r\n\r\n", Transfer_Encoding="chunked"), 411)
    check("by nobody", served.post("view", "b", VIEW), 404)
    check("of nothing", served.post("nothing", "a", {}), 404)
    check("too long", served.post("lamps", "a", b"{}", Content_Length=10 ** 9), 413)
    for what, body in (("no JSON", b"view"), ("no object", b"[]"), ("deep", b"[" * 100000), ("empty", b"{}"),
                       ("a huge picture", {**VIEW, "width": 10 ** 9}), ("no direction", {**VIEW, "forward": [0, 0, 0]}),
                       ("words", {**VIEW, "eye": ["a", 0, 0]}), ("another sky", {**VIEW, "sky": [1, 2, 3]}),
                       ("more", {**VIEW, "file": "/etc/passwd"})):
        check(what, served.post("view", "a", body), 400)
    check("luminaires where none are edited", served.post("luminaires", "a", {"save": True}), 404)
    check("a year without weather", served.post("year", "a", {}), 404)
    check("light for nobody", served.request("light?viewer=b&since=0")[0], 404)
    mix, ray = [[1, 1, 1, 1]], {"eye": [2, 1, 3], "direction": [0, -1, 0]}
    served.post("view", "a", {**VIEW, "glare": True})
    while served.post("glare", "a", {"mix": mix, "limit": 3}) == 404:
        time.sleep(0.1)
    for what, body, status in (
            ("exr", {"mix": mix}, 200), ("glare", {"mix": mix, "limit": 3}, 200), ("photons", ray, 200),
            ("exr", {}, 400), ("exr", {"mix": [*mix, *mix]}, 400), ("exr", {"mix": [[1, 1, 1]]}, 400),
            ("exr", {"mix": [["a", 1, 1, 1]]}, 400), ("exr", {"mix": [[-1, 1, 1, 1]]}, 400),
            ("exr", {"mix": mix, "file": "/etc/passwd"}, 400), ("glare", {"mix": mix, "limit": 0}, 400),
            ("glare", {"mix": mix}, 400), ("photons", {}, 400), ("photons", {**ray, "direction": [0, 0, 0]}, 400),
            ("photons", {**ray, "eye": [1e30, 0, 0]}, 400), ("photons", {**ray, "direction": [0, 1, 0]}, 404),
            ("settings", {"neighbours": 0}, 400), ("settings", {"neighbours": "many"}, 400),
            ("settings", {"photons_emitted": 1e30}, 400), ("settings", {"radius": -1}, 400),
            ("settings", {"maps": "none"}, 400), ("settings", {"maps": "naive"}, 400),
            ("settings", {"light_maps": "off"}, 400), ("settings", {"statistics": "/tmp/file"}, 400),
            ("moods", {"write": "../../outside"}, 200), ("moods", {"write": 7}, 400)):
        check(f"{what} {body}", served.post(what, "a", body), status)
    check("no copy of a mood that is not there", list(FOLDER.glob("hall.*.obj")), [])
    point = {"number": 1, "place": [0, 0, 0], "normal": [0, 1, 0]}
    for what, damage in (("a damaged point", {"normal": [9, 0, 0]}), ("one without a number", {"number": None}),
                         ("one of a negative number", {"number": -1})):
        check(what, served.post("point", "a", {**point, **damage}), 400)
    sent = [served.post("point", "a", {**point, "number": number}) for number in range(1, 102)]
    check("too many points", (sent[:99].count(200), sent[99:]), (99, [400, 400]))
    for what, body in (("one in place of another", {**point, "number": 5}), ("one less", {"number": 7}),
                       ("one more", {**point, "number": 200})):
        check(what, served.post("point", "a", body), 200)
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
    light = served.request("light?viewer=first&since=0")[2]
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
        check("by Ctrl-C", served.interrupt(), 0)
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


def test_luminaires(folder):
    """They are placed into a room that has no lamp, by a file that does not exist yet."""
    scene, lamps = room_of_gallery(SOURCE, folder), folder / "lamps.json"
    outside = folder.parent / "outside.ies"
    with Served(PHOTILE, scene, "--luminaires", lamps, *QUICK[:-1]) as served:
        page, other = Page(served, "a"), Page(served, "b")
        check("photometric files", page.hear("luminaires")["files"], ["downlight.ies"])
        post = lambda **edit: served.post("luminaires", "a", edit)
        for what, edit in (
                ("another file", {"file": str(outside)}), ("a file above", {"file": "../outside.ies"}),
                ("no file", {"file": 7}), ("more", {"path": "/etc/passwd"}), ("no entry", {"select": 1e9}),
                ("a ray", {"pick": [1, 2]}), ("a crooked ray", {"pick": {"eye": [0, 0, 0], "direction": [9, 0, 0],
                                                                         "farthest": 1}}),
                ("far away", {"place": {"place": [1e30, 0, 0], "normal": [0, 1, 0]}}), ("words", {"rotate": "a"}),
                ("beyond a circle", {"rotate": 1e9}), ("less than none", {"lumens": -1}),
                ("no pairs", {"array": {"count": [1], "spacing": [1, 1]}}), ("no object", {"drag": True})):
            check(f"luminaires: {what}", post(**edit), 400)
        check("nothing is selected", post(remove=True, duplicate=True, rotate=15), 200)
        check("a lamp", post(place={"place": [0.5, 2.9, 0.25], "normal": [0, -1, 0]}), 200)
        heard = other.hear("luminaires", lambda news: news["entries"])
        check("the other page hears", heard["entries"][0]["name"], "downlight")
        check("many of it", post(array={"count": [101, 1], "spacing": [1, 1]}), 400)
        check("numbers", post(lumens=500, array={"count": [2, 1], "spacing": [0.8, 0]}, rotate=30), 200)
        check("no file yet", lamps.exists(), False)
        check("the room with it", page.hear("reload"), True)
        status, _, content = served.request("light?viewer=a&since=0")
        check("what the old page asks for", (status, content), (204, b""))
        check("its lights", [light["name"] for light in served.room()["lights"]], ["downlight"])
        number = re.search('"live":(\\d+)', served.request()[2].decode()).group(1)
        page = Page(served, f"c&since={number}")
        check("what a new page hears", page.hear("luminaires")["unsaved"], True)
        post = lambda **edit: served.post("luminaires", "c", edit)
        check("a copy", post(duplicate=True), 200)
        check("two", page.hear("luminaires", lambda news: len(news["entries"]) == 2)["selected"], 1)
        check("undone", post(undo=True), 200)
        check("one", len(page.hear("luminaires", lambda news: len(news["entries"]) == 1)["entries"]), 1)
        check("saved", post(save=True), 200)
        entry, = json.loads(lamps.read_text())
        check("the file", entry, {**entry, "name": "downlight", "file": "downlight.ies", "lumens": 500, "rotation": 30,
                                  "count": [2, 1], "spacing": [0.8, 0]})
        check("done again", post(redo=True), 200)
        page.hear("luminaires", lambda news: news["unsaved"])
        check("by Ctrl-C", served.interrupt(), 0)
    time.sleep(0.2)
    assert any("changes to luminaires are not saved" in line for line in served.said), served.said


def test_maps(folder):
    """A room whose maps are saved opens with its light, from where options say."""
    scene, maps = write_hall(folder), folder / "hall.maps"
    with Served(PHOTILE, scene, "--save-maps", maps, *QUICK) as served:
        page = Page(served, "a")
        served.post("view", "a", VIEW)
        page.hear("work", lambda work: work is None)
        check("by Ctrl-C", served.interrupt(), 0)
    assert maps.stat().st_size > 20_000 * 12, maps.stat().st_size
    opening = ["--eye", "1,1.25,3", "--look-at", "1,1.25,0"]
    with Served(PHOTILE, scene, "--load-maps", maps, *opening, *QUICK) as served:
        page = Page(served, "a")
        served.post("view", "a", VIEW)
        stages = []
        page.hear("work", lambda work: stages.append(work and work["stage"]) or work is None)
        print(f"stages: {stages}")
        assert "trace photons" not in stages, stages
        room = served.room()
        check("the eye", room["cameras"][0]["position"], [1, 1.25, 3])
        check("its direction", [round(part, 6) + 0.0 for part in room["cameras"][0]["forward"]], [0, 0, -1])


def test_year(folder):
    """Figures of a year come when they are asked for, and get finer; the hours are those of the weather."""
    weather = folder / "year.epw"
    days = (31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
    rows = "".join(f"2005,{month + 1},{day + 1},{hour},60,?9,10.0,5.5,70,101300,0,0,300,0,{400 * (8 < hour < 17)},"
                   f"{150 * (8 < hour < 17)},0,0,0\n" for month in range(12) for day in range(days[month])
                   for hour in range(1, 25))
    weather.write_text("LOCATION,Somewhere,-,ZZZ,test,000000,52.50,13.40,1.0,34.0\n" + "".join(
        f"{line}\n" for line in ("DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
                                 "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,", "COMMENTS 2,",
                                 "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31")) + rows)
    with Served(PHOTILE, room_of_gallery(SOURCE, folder), "--weather", weather, *QUICK) as served:
        page = Page(served, "a")
        check("before it is asked for", page.hear("year"), {"running": False, "lines": []})
        check("asked for", served.post("year", "a", {}), 200)
        first = page.hear("year", lambda year: year["lines"])
        print(first)
        assert first["running"] and any("sDA" in line for line in first["lines"]), first
        second = page.hear("year", lambda year: year["lines"] != first["lines"])
        print(second)
        room = served.room()
        check("days", (len(room["hours"]["days"]), room["hours"]["weather"]), (12, True))
        for what, power, status in (("a sky", 1, 200), ("a negative one", -1, 400), ("one beyond numbers", 1e39, 400)):
            check(what, served.post("view", "a", {**VIEW, "sky": [power] * len(room["lights"])}), status)


if __name__ == "__main__":
    PHOTILE, SOURCE = sys.argv[2], pathlib.Path(sys.argv[3])
    with tempfile.TemporaryDirectory() as name:
        FOLDER = pathlib.Path(name)
        globals()[f"test_{sys.argv[1]}"](FOLDER)
