"""The transport of responses: encodings of the page and of the API, their ETags, and headers about
rates and policies."""
import gzip
import re

import pytest
from support.meshes import folded_grid
from support.raw_http import raw_request

T = "/tables/finds"


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(5), "grid.ply", name="Grid", unit="mm")
    return server


def test_the_page_travels_well(server):
    """The server sends the files of the build with the encodings that the build made."""
    page = server.get("//", token=False, headers={"Accept-Encoding": "gzip, br"})
    script = re.search(rb'src="(/assets/[^"]+\.js)"', page.body)[1].decode()
    plain = server.get("/" + script, token=False)
    assert (
        plain.headers["Content-Encoding"] is None and plain.headers["Vary"] == "Accept-Encoding"
    ), plain.headers
    etags = {plain.headers["ETag"]}
    for coding in ("gzip", "br"):
        coded = server.get("/" + script, token=False, headers={"Accept-Encoding": coding})
        assert (
            coded.headers["Content-Encoding"] == coding
            and coded.headers["Vary"] == "Accept-Encoding"
        ), coded.headers
        assert (
            coded.headers["Content-Type"] == plain.headers["Content-Type"]
            and len(coded.body) < len(plain.body) / 2
        )
        etags.add(coded.headers["ETag"])
        again = server.get(
            "/" + script,
            token=False,
            headers={"Accept-Encoding": coding, "If-None-Match": coded.headers["ETag"]},
        )
        assert again.status == 304 and not again.body, again
    assert len(etags) == 3, "each coding is a representation of its own"
    unzipped = server.get("/" + script, token=False, headers={"Accept-Encoding": "gzip"})
    assert gzip.decompress(unzipped.body) == plain.body
    assert server.get("/" + script + ".map", token=False).status == 200, "source maps are served"
    head = raw_request(
        server,
        f"HEAD {script} HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: br\r\nConnection: close\r\n\r\n".encode(),
    ).decode()
    assert "Content-Encoding: br\r\n" in head and head.endswith("\r\n\r\n"), head


def test_answers_of_the_api_travel_well(server):
    server.ok("POST", "/projects/default/tables", {"name": "Finds", "columns": [{"name": "Note"}]})
    for i in range(60):
        server.ok(
            "POST", T + "/records", {"values": {"note": f"a find with a long note, number {i}"}}
        )
    for path in ("/openapi.json", T + "/records", T + "/records?f=csv", "//docs"):
        plain = server.get(path, headers={"Accept-Encoding": "identity"})
        zipped = server.get(path, headers={"Accept-Encoding": "gzip"})
        assert zipped.headers[
            "Content-Encoding"
        ] == "gzip" and "Accept-Encoding" in zipped.headers.get_all("Vary"), (
            path,
            zipped.headers.items(),
        )
        assert (
            gzip.decompress(zipped.body) == plain.body and len(zipped.body) < len(plain.body) / 2
        ), path
        brotli = server.get(path, headers={"Accept-Encoding": "br"})
        assert (
            brotli.headers["Content-Encoding"] == "br" and len(brotli.body) < len(plain.body) / 2
        ), path
    # the ETag of an encoded response is equivalent to the ETag without encoding
    server.ok("PATCH", T, {"description": "x" * 1500})
    for coding in ("identity", "gzip", "br"):
        read = server.get(T, headers={"Accept-Encoding": coding})
        etag = read.headers["ETag"]
        assert (read.headers["Content-Encoding"] or "identity") == coding and (
            coding == "identity" or etag.endswith(f'-{coding}"')
        ), read.headers
        assert (
            server.get(T, headers={"If-None-Match": etag, "Accept-Encoding": coding}).status == 304
        )
        assert (
            server.request(
                "PATCH", T, {"name": "Finds " + coding}, headers={"If-Match": etag}
            ).status
            == 200
        )
        assert (
            server.request("PATCH", T, {"name": "Stale"}, headers={"If-Match": etag}).status == 412
        )


def test_headers(server):
    answer = server.get("/models")
    policy = re.fullmatch(r'"connection";q=(\d+);w=(\d+)', answer.headers["RateLimit-Policy"])
    left = re.fullmatch(r'"connection";r=(\d+);t=(\d+)', answer.headers["RateLimit"])
    assert policy and left and int(left[1]) <= int(policy[1]), answer.headers
    assert (
        "camera=()" in answer.headers["Permissions-Policy"]
        and answer.headers["Strict-Transport-Security"] is None
    ), answer.headers
    behind = server.get("/models", headers={"X-Forwarded-Proto": "https"})
    assert behind.headers["Strict-Transport-Security"] == "max-age=31536000", behind.headers


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
