"""Hostile texts, names and files in all inputs of tables, records and attachments. The server
refuses them or stores them as plain text."""
import json
import struct
import urllib.parse
import zlib

import pytest

TEXTS = [
    "'; DROP TABLE projects; --",
    '" OR 1=1 --',
    "x'); DELETE FROM record_tables; --",
    "1; SELECT pg_sleep(100)",
    "$1",
    "%s%n",
    "\\x27",
    "{{7*7}}",
    "${jndi:ldap://x}",
    "../../../../etc/passwd",
    "..\\..\\windows\\system32",
    "/etc/passwd",
    "%2e%2e%2f",
    "file:///etc/passwd",
    "<script>alert(1)</script>",
    "javascript:alert(1)",
    '"><img src=x onerror=alert(1)>',
    "=cmd|'/c calc'!A1",
    "@SUM(1+1)",
    "-2+3",
    "photo\u202egpj.exe",
    "\u200b",
    "\ufeff",
    "a\tb\nc",
    "A" * 1000,
    "\U0001f3fa" * 300,
    "CON",
    "...",
    "~",
    "-rf",
    "c1",
    "key",
    "version",
    "records.t1",
    "null",
    "true",
    "NaN",
    "1e999",
    "-1",
    "99999999999999999999",
]
IN_PLACE = (
    "image/jpeg",
    "image/png",
    "image/tiff",
    "image/webp",
    "image/gif",
    "image/heic",
    "image/avif",
    "image/bmp",
    "image/jp2",
    "application/pdf",
)


def quoted(text):
    return urllib.parse.quote(text, safe="")


class Site:
    """The state that must be the same after every attempt."""

    def __init__(self, server):
        self.server = server
        self.tables = self.count()

    def count(self):
        return self.server.ok("GET", "/projects/default/tables?limit=1000").json()["total"]

    def check(self, what):
        assert self.count() == self.tables, f"{what}: tables came or went"
        kept = self.server.ok("GET", "/tables/kept/records/1").json()
        assert kept["values"]["note"] == "stays", f"{what}: {kept}"


@pytest.fixture(scope="module", autouse=True)
def site(server):
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Kept", "columns": [{"name": "Note"}, {"name": "Files", "kind": "document"}]},
    )
    server.ok("POST", "/tables/kept/records", {"values": {"note": "stays"}})
    return Site(server)


def test_texts_as_names(server, site):
    """Names stay unchanged. Requests use the slug, which contains only letters."""
    for text in TEXTS:
        made = server.request(
            "POST",
            "/projects/default/tables",
            {
                "name": text,
                "description": text,
                "labels": {"en": text},
                "columns": [
                    {"name": text[:200], "comment": text, "labels": {"en": text}},
                    {"name": "Choice", "kind": "enumeration", "choices": [text]},
                ],
            },
        )
        if made.status == 201:
            table = made.json()
            assert table["name"] == text and set(table["slug"]) <= set(
                "abcdefghijklmnopqrstuvwxyz0123456789-"
            ), table
            path = f"/tables/{table['id']}"
            column = table["columns"][0]["slug"]
            record = server.ok(
                "POST", path + "/records", {"values": {column: text, "choice": text}}
            )
            held = record.json()["values"][column]
            assert held == (text if text.strip(" \t\r\n") else None), (text, held)
            csv = server.ok("GET", path + "/records?f=csv").body.decode("utf-8-sig")
            assert not any(
                cell.startswith(("=", "@"))
                for line in csv.splitlines()[1:]
                for cell in line.replace('"', "").split(",")
            ), csv
            server.ok(
                "PATCH",
                path + f"/columns/{column}",
                {"name": text[:200] or "x", "kind": "document"},
            )
            server.ok("DELETE", path)
        else:
            assert made.status in (400, 422), f"{text!r}: {made}"
        site.check(repr(text))


def test_texts_in_addresses(server, site):
    for text in TEXTS:
        q = quoted(text)
        for method, path in [
            ("GET", f"/tables/{q}"),
            ("GET", f"/tables/{q}/records"),
            ("DELETE", f"/tables/{q}"),
            ("GET", f"/tables/kept/records/{q}"),
            ("DELETE", f"/tables/kept/records/{q}"),
            ("GET", f"/tables/kept/records?sortby={q}"),
            ("GET", f"/tables/kept/records?limit={q}"),
            ("GET", f"/tables/kept/records?at={q}"),
            ("GET", f"/tables/kept/records?f={q}"),
            ("GET", f"/tables/kept/records?f=csv&separator={q}"),
            ("DELETE", f"/tables/kept/columns/{q}"),
            ("GET", f"/tables/kept/edits?key={q}"),
            ("GET", f"/tables/kept/columns/{q}/cycles"),
            ("GET", f"/attachments/{q}"),
            ("DELETE", f"/attachments/{q}"),
            ("GET", f"/attachments/1?thumbnail={q}"),
            ("GET", f"/tables/kept/records/{q}/attachments"),
            ("GET", f"/projects/{q}/tables"),
        ]:
            answer = server.request(method, path)
            assert answer.status < 500, f"{method} {path}: {answer}"
            harmless = (
                answer.status >= 400
                or (method == "GET" and text in ("key", "-1", "version", "null", "true"))
                or "sortby=" in path
            )
            assert harmless or (
                method == "GET" and answer.status == 200
            ), f"{method} {path}: {answer}"
        site.check(repr(text))
    for path in [
        "//api/v1/attachments/..%2f..%2f..%2fetc%2fpasswd",
        "//api/v1/attachments/1/../../../../etc/passwd",
        "//..%2f..%2fetc%2fpasswd",
        "//api/v1/attachments/%2e%2e/%2e%2e/etc/passwd",
        "//api/v1/attachments/1%00",
        "//%c0%ae%c0%ae/etc/passwd",
    ]:
        answer = server.request("GET", path)
        assert b"root:" not in answer.body and (
            answer.status >= 400 or b"<html" in answer.body.lower()
        ), f"{path}: {answer}"


def test_texts_in_bodies(server, site):
    for text in TEXTS:
        for body in [
            {"values": {text: "x"}},
            {"key": text, "values": {}},
            {"values": {"note": {"$gt": text}}},
            {"values": {"files": [text]}},
            {"values": {"files": text}},
            {"values": text},
            {"records": [{"values": {"note": [text]}}]},
        ]:
            answer = server.post("/tables/kept/records", body)
            assert answer.status in (400, 422), f"{body!r:.200}: {answer}"
        answer = server.post(
            "/tables/kept/records",
            f"{json.dumps(text)},note\nx,y\n".encode(),
            headers={"Content-Type": "text/csv"},
        )
        named = text == "key"
        assert answer.status == 422, (
            f"{text!r} as a head of CSV: {answer}" if not named else f"{answer}"
        )
        answer = server.request(
            "PATCH",
            "/tables/kept/records/1",
            {"values": {"note": "changed"}},
            headers={"If-Match": ascii(text)},
        )
        assert answer.status == 412, answer
        site.check(repr(text))


def test_names_of_files(server):
    for text in TEXTS:
        made = server.request(
            "POST", f"/tables/kept/records/1/attachments?name={quoted(text)}", b"plain text"
        )
        assert made.status == 201, f"{text!r}: {made}"
        file = made.json()["attachments"][0]
        name = file["name"]
        assert (
            1 <= len(name.encode()) <= 255
            and "/" not in name
            and "\\" not in name
            and name not in (".", "..")
        ), name
        assert not any(mark in name for mark in "\u202e\u200b\ufeff\t\n"), repr(name)
        read = server.ok("GET", f"/attachments/{file['id']}")
        way = read.headers["Content-Disposition"]
        assert (
            read.body == b"plain text"
            and way == "attachment; filename*=UTF-8''" + urllib.parse.quote(name, safe="-._~")
        ), way
        assert read.headers.get_all("Content-Disposition") == [way]
        server.ok("DELETE", f"/attachments/{file['id']}")
    raw = '--X\r\nContent-Disposition: form-data; name="f"; filename="../..\\evil\x07\u202e.sh"\r\nContent-Type: text/html\r\n\r\nx\r\n--X--\r\n'.encode()
    made = server.ok(
        "POST",
        "/tables/kept/records/1/attachments",
        raw,
        headers={"Content-Type": "multipart/form-data; boundary=X"},
    ).json()
    assert (
        made["attachments"][0]["name"] == "evil.sh"
        and made["attachments"][0]["media_type"] == "text/plain"
    ), made


def png_head(width, height):
    def part(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    return (
        b"\x89PNG\r\n\x1a\n"
        + part(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
        + part(b"IDAT", zlib.compress(b""))
        + part(b"IEND", b"")
    )


def test_hostile_files(server):
    """No file runs as a script in the server's origin, with any name and any declared type."""
    for name, body, media_type in [
        ("photo.jpg", b"<html><script>fetch('/api/v1/projects')</script>", "text/html"),
        (
            "photo.png",
            b"<svg xmlns='http://www.w3.org/2000/svg' onload='alert(1)'/>",
            "image/svg+xml",
        ),
        (
            "drawing.svg",
            b"<?xml version='1.0'?><!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><svg>&x;</svg>",
            "image/svg+xml",
        ),
        ("page.pdf", b"  <!DOCTYPE html><body onload=alert(1)>", "text/html"),
        ("both.gif", b"GIF89a/*<script>*/=1;alert(1)//", "image/gif"),
        ("both.pdf", b"%PDF-1.7<html><script>alert(1)</script>", "application/pdf"),
        ("both.zip", b"PK\x03\x04" + bytes(26) + b"<html>", "application/zip"),
        ("wide.html", "\ufeff<html>".encode("utf-16"), "application/octet-stream"),
        ("seven.html", b"+ADw-script+AD4-alert(1)+ADw-/script+AD4-", "text/plain"),
        ("run.exe", b"MZ\x90\x00", "application/octet-stream"),
        ("script.js", b"alert(document.cookie)", "text/plain"),
        ("style.css", b"body{background:url(//evil)}", "text/plain"),
        ("bomb.png", png_head(16000, 16000), "image/png"),
        ("larger.png", png_head(2**31 - 1, 2**31 - 1), "image/png"),
        ("cut.jpg", b"\xff\xd8\xff\xe1\xff\xff", "image/jpeg"),
        ("loop.jpg", b"\xff\xd8" + b"\xff\xe1\x00\x10Exif\0\0II*\0\x08\0\0\0" * 50, "image/jpeg"),
    ]:
        made = server.ok(
            "POST",
            f"/tables/kept/records/1/attachments?column=files&name={name}",
            body,
            headers={"Content-Type": "image/png"},
        ).json()["attachments"][0]
        assert made["media_type"] == media_type, (name, made)
        path = f"/attachments/{made['id']}"
        read = server.ok("GET", path)
        assert read.body == body and read.headers["Content-Type"] == media_type
        assert read.headers.get_all("X-Content-Type-Options") == ["nosniff"]
        assert read.headers.get_all("Content-Security-Policy") == ["sandbox; default-src 'none'"]
        assert read.headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert read.headers["Content-Disposition"].startswith(
            "inline" if media_type in IN_PLACE else "attachment"
        ), (name, read.headers)
        assert server.get(path + "?thumbnail=256").status in (415, 422), name


def test_all_else_is_as_it_was(site):
    site.check("all of it")


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
