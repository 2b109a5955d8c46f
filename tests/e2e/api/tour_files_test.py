"""Files and the design of tours over HTTP: the files that a tour accepts and the way the server
sends them, refused colors, names of classes, and the link for visitors' phones."""
import struct

import pytest
from support.addresses import query
from support.kiosk_site import ALL, PNG, TOUR, make_kiosk, make_site, told

WAV = (
    b"RIFF"
    + struct.pack("<I", 2036)
    + b"WAVEfmt "
    + struct.pack("<IHHIIHH", 16, 1, 1, 8000, 16000, 2, 16)
    + b"data"
    + struct.pack("<I", 2000)
    + bytes(2000)
)
MP4 = struct.pack(">I", 24) + b"ftypmp42" + bytes(4) + b"mp42isom" + bytes(600)
VTT = b"WEBVTT\n\n00:00.000 --> 00:02.000\nThe well\n"


@pytest.fixture(scope="module", autouse=True)
def tour(server):
    make_site(server)
    server.ok("POST", ALL, TOUR)
    return ALL + "/once-around"


def add(server, tour, name, content, **more):
    return server.request("POST", query(tour + "/files", name=name), content, **more)


def change(server, tour, body):
    version = server.get(tour).json()["version"]
    return server.request("PATCH", tour, body, headers={"If-Match": f'"v{version}"'})


def test_a_tour_accepts_what_browsers_show_and_play(server, tour, story):
    kinds = {}
    for name, content, kind, media_type in (
        ("west.png", PNG, "picture", "image/png"),
        ("voice.wav", WAV, "sound", "audio/wav"),
        ("film.mp4", MP4, "video", "video/mp4"),
        ("en.vtt", VTT, "subtitles", "text/vtt"),
    ):
        made = add(server, tour, name, content)
        assert made.status == 201, made
        file = made.json()
        assert (file["name"], file["kind"], file["media_type"]) == (name, kind, media_type), file
        assert made.headers["Location"] == f"/api/v1{tour}/files/{file['id']}"
        assert server.get(f"{tour}/files/{file['id']}").body == content
        kinds[kind] = file["id"]
    story.files = kinds
    assert "files" not in server.get(tour).json(), "no stop uses them yet"


@pytest.mark.parametrize(
    "name,content,status",
    [
        ("logo.svg", b"<svg xmlns='http://www.w3.org/2000/svg'><script>1</script></svg>", 415),
        ("page.png", b"<html><script>1</script></html>", 415),
        ("cut.png", PNG[:20], 422),
        ("text.vtt", b"WEBVTTX\n", 415),
        ("paper.pdf", b"%PDF-1.7\n", 415),
        ("nothing.png", b"", 400),
    ],
)
def test_others_are_refused(server, tour, name, content, status):
    answer = add(server, tour, name, content)
    assert answer.status == status and answer.json()["detail"], answer


def test_pictures_have_a_limit(server, tour):
    huge = (
        b"\x89PNG\r\n\x1a\n"
        + struct.pack(">I", 13)
        + b"IHDR"
        + struct.pack(">IIBBBBB", 9000, 10, 8, 2, 0, 0, 0)
    )
    told(add(server, tour, "huge.png", huge + bytes(100)), 422)


def test_players_read_parts_and_no_file_runs_scripts(server, tour, story):
    address = f"{tour}/files/{story.files['sound']}"
    part = server.request("GET", address, headers={"Range": "bytes=4-7"})
    assert part.status == 206 and part.body == WAV[4:8], part
    assert part.headers["Content-Range"] == f"bytes 4-7/{len(WAV)}"
    assert part.headers["Content-Security-Policy"].startswith("sandbox")
    assert server.request("GET", address, headers={"Range": "bytes=9999-"}).status == 416
    told(server.get(address + "?thumbnail=256"), 415)
    small = server.get(f"{tour}/files/{story.files['picture']}?thumbnail=64")
    assert small.headers["Content-Type"] == "image/jpeg"
    told(server.get(f"{tour}/files/999"), 404)


def test_stops_show_files_of_their_own_tour(server, tour, story):
    picture, sound, video, text = (
        story.files[kind] for kind in ("picture", "sound", "video", "subtitles")
    )
    stops = server.get(tour).json()["stops"]

    def with_media(*media):
        return {"stops": [{**stops[0], "media": list(media)}, stops[1]]}

    for media, field in (
        ([{"file": 999}], "stops[0].media[0].file"),
        ([{"file": text}], "stops[0].media[0].file"),
        ([{"file": picture}, {"file": picture}], "stops[0].media[1].file"),
        ([{"file": picture, "subtitles": {"en": text}}], "stops[0].media[0].subtitles"),
        ([{"file": video, "subtitles": {"en": sound}}], "stops[0].media[0].subtitles.en"),
        ([{"file": sound, "alt": {"fr": "Voix"}}], "stops[0].media[0].alt.fr"),
    ):
        told(change(server, tour, with_media(*media)), 422, field)
    media = [
        {"file": video, "caption": {"en": "The well"}, "subtitles": {"en": text}},
        {"file": picture, "alt": {"en": "A well", "es": "Un pozo"}},
    ]
    changed = change(server, tour, with_media(*media))
    assert changed.status == 200, changed
    now = server.get(tour).json()
    assert now["stops"][0]["media"] == media and "media" not in now["stops"][1]
    assert [file["id"] for file in now["files"]] == sorted((video, picture, text))
    told(change(server, tour, {"languages": ["en"], "stops": now["stops"]}), 422)
    told(server.post(ALL, {**TOUR, "stops": now["stops"]}), 422, "stops[0].media[0].file")


def test_the_design_is_readable_or_refused(server, tour, story):
    for theme, field in (
        ({"background": "#303030"}, "theme.background"),
        ({"mode": "dark", "background": "#f0f0f0"}, "theme.background"),
        ({"accent": "#f0e0c0"}, "theme.accent"),
        ({"logo": story.files["sound"]}, "theme.logo"),
        ({"accent": "red"}, "theme.accent"),
        ({"font": "comic"}, "theme.font"),
    ):
        told(change(server, tour, {"theme": theme}), 422, field)
    theme = {"mode": "dark", "accent": "#e0a458", "logo": story.files["picture"], "logo_alt": "M"}
    assert change(server, tour, {"theme": theme}).json()["theme"] == theme
    assert "theme" not in change(server, tour, {"theme": {}}).json(), "an empty one removes it"


def test_classes_have_names_in_the_languages_of_the_tour(server, tour):
    names = [{"value": 1, "names": {"es": "Grieta"}}]
    told(change(server, tour, {"classes": [{"layer": "nothing", "classes": names}]}), 422)
    twice = [{"layer": "cracks", "classes": names + names}]
    told(change(server, tour, {"classes": twice}), 422, "classes[0].classes[1].value")
    french = [{"layer": "cracks", "classes": [{"value": 1, "names": {"fr": "Fissure"}}]}]
    told(change(server, tour, {"classes": french}), 422, "classes[0].classes[0].names.fr")
    own = [{"layer": "cracks", "classes": names}]
    assert change(server, tour, {"classes": own}).json()["classes"] == own


def test_phones_see_what_the_screen_sees_until_their_link_is_switched_off(server, tour, story):
    kiosk, secret = make_kiosk(server, tour)
    assert kiosk["phones"] is False
    assert "phone_path" not in server.get("/kiosk", token=secret).json()
    switched = server.ok("PATCH", f"/kiosks/{kiosk['id']}", {"phones": True}).json()
    assert switched["phones"] and "phone_path" not in switched, "only the screen gets the link"
    phone = server.get("/kiosk", token=secret).json()["phone_path"].rpartition("/")[2]
    assert phone != secret
    own = server.ok("POST", "/auth/kiosk", {"link": phone}, token=False).json()
    assert own["is_phone"] and "phone_path" not in own and not own["wants_reload"]
    seen = next(
        each for each in server.get("/kiosks").json()["kiosks"] if each["id"] == kiosk["id"]
    )
    address = f"{tour}/files/{story.files['picture']}"
    assert server.get(address, token=phone).body == PNG
    told(server.request("PATCH", f"/kiosks/{kiosk['id']}", {"phones": False}, token=phone), 403)
    server.ok("POST", f"/kiosks/{kiosk['id']}/reload")
    server.ok("POST", "/auth/kiosk", {"link": phone}, token=False)
    assert server.get("/kiosk", token=secret).json()["wants_reload"], "a phone is not the screen"
    server.ok("PATCH", f"/kiosks/{kiosk['id']}", {"phones": False})
    told(server.get("/kiosk", token=phone), 401)
    assert server.get("/kiosk", token=secret).status == 200
    server.ok("PATCH", f"/kiosks/{kiosk['id']}", {"phones": True})
    again = server.get("/kiosk", token=secret).json()["phone_path"].rpartition("/")[2]
    assert again != phone
    server.ok("DELETE", f"/kiosks/{kiosk['id']}")
    told(server.get("/kiosk", token=again), 401)
    told(server.request("PATCH", f"/kiosks/{kiosk['id']}", {"phones": True}), 409)
    assert seen["phones"]


def test_a_kiosk_of_another_tour_sees_none_of_the_files(server, tour, story):
    other = server.ok("POST", ALL, {**TOUR, "name": "Another"}).json()
    _, secret = make_kiosk(server, f"{ALL}/{other['slug']}")
    told(server.get(f"{tour}/files/{story.files['picture']}", token=secret), 404)
    told(server.get(f"{ALL}/{other['slug']}/files/{story.files['picture']}", token=secret), 404)
