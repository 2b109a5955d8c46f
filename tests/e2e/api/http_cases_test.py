"""The responses of the HTTP interface to invalid requests: first a table, then the cases with
several steps."""
import concurrent.futures
import json
import os
import subprocess
import uuid

import pytest
from support.cameras import camera_from
from support.meshes import bumpy_ball, folded_grid
from support.raw_http import raw_request
from support.strata_server import wait_for

M, L = "/models/grid", "/models/grid/layers/marks"
FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}


def table(camera):
    """Returns rows of (description, method, path, body, headers, status, field)."""
    stroke = {"op": "stroke", "value": 1, "camera": camera, "radius_px": 5, "path": [[320, 240]]}
    pick = {"camera": camera, "x": 10, "y": 10}

    def without(body, name):
        return {k: v for k, v in body.items() if k != name}

    singular = {**camera, "view": [0] * 16}
    json_type = {"Content-Type": "application/json"}
    return [
        ("unknown model", "GET", "/models/nothing", None, {}, 404, None),
        ("unknown layer", "GET", M + "/layers/nothing", None, {}, 404, None),
        ("unknown layer to paint", "POST", M + "/layers/nothing/edits", FILL, {}, 404, None),
        ("unknown job", "GET", "/jobs/999", None, {}, 404, None),
        ("a job that is no number", "GET", "/jobs/first", None, {}, 404, None),
        ("unknown address of the API", "GET", "/nothing", None, {}, 404, None),
        ("unknown source file", "GET", M + "/source/other.ply", None, {}, 404, None),
        ("unknown raster format", "GET", L + "/texels.bmp", None, {}, 404, None),
        ("a huge id", "GET", "/models/99999999999999999999999", None, {}, 404, None),
        ("an empty name", "GET", "/models//layers", None, {}, 404, None),
        ("wrong method on a list", "PUT", "/models", None, {}, 405, None),
        ("wrong method on an edit", "DELETE", L + "/edits", None, {}, 405, None),
        ("wrong method on a query", "GET", M + "/pick", None, {}, 405, None),
        ("live without upgrade", "GET", M + "/live", None, {}, 426, None),
        ("no JSON", "POST", L + "/edits", b"{", json_type, 400, None),
        ("nothing at all", "POST", L + "/edits", b"", json_type, 400, None),
        ("two JSON values", "POST", L + "/edits", b"{} {}", json_type, 400, None),
        ("NaN", "POST", M + "/pick", b'{"x":NaN}', json_type, 400, None),
        ("not UTF-8", "POST", M + "/layers", b'{"name":"\xff"}', json_type, 400, None),
        (
            "a NUL in a name",
            "POST",
            M + "/layers",
            b'{"name":"a\\u0000b"}',
            json_type,
            (400, 422),
            None,
        ),
        ("nested without end", "POST", L + "/edits", b"[" * 100000, json_type, (400, 422), None),
        ("a list instead of an object", "POST", L + "/edits", [], {}, 422, None),
        ("limit of zero", "GET", "/models?limit=0", None, {}, (400, 422), "limit"),
        ("limit too large", "GET", "/models?limit=100000", None, {}, (400, 422), "limit"),
        ("negative offset", "GET", L + "/edits?offset=-1", None, {}, (400, 422), "offset"),
        ("unknown query parameter", "GET", "/models?colour=red", None, {}, (400, 422), "colour"),
        ("unknown op", "POST", L + "/edits", {"op": "wash"}, {}, 422, "op"),
        ("no op", "POST", L + "/edits", without(FILL, "op"), {}, 422, "op"),
        ("value too large for u8", "POST", L + "/edits", {**FILL, "value": 256}, {}, 422, "value"),
        ("value negative for u8", "POST", L + "/edits", {**FILL, "value": -1}, {}, 422, "value"),
        ("value with a fraction", "POST", L + "/edits", {**FILL, "value": 1.5}, {}, 422, "value"),
        ("value as text", "POST", L + "/edits", {**FILL, "value": "1"}, {}, 422, "value"),
        ("value missing", "POST", L + "/edits", without(FILL, "value"), {}, 422, None),
        (
            "unknown member",
            "POST",
            L + "/edits",
            {**FILL, "sql": "DROP TABLE edits"},
            {},
            422,
            "sql",
        ),
        (
            "expression not known",
            "POST",
            L + "/edits",
            {**FILL, "where": "1=1; DROP TABLE edits"},
            {},
            422,
            "where",
        ),
        (
            "a condition over an unknown layer",
            "POST",
            L + "/edits",
            {**FILL, "where": "salt > 1"},
            {},
            422,
            "where",
        ),
        (
            "a number for a condition",
            "POST",
            L + "/edits",
            {**FILL, "where": "1 + 1"},
            {},
            422,
            "where",
        ),
        (
            "an unknown mode of filling",
            "POST",
            L + "/edits",
            {**FILL, "mode": "all"},
            {},
            422,
            "mode",
        ),
        (
            "a piece without a place",
            "POST",
            L + "/edits",
            {**FILL, "mode": "island"},
            {},
            422,
            "at",
        ),
        (
            "a place beside the model",
            "POST",
            L + "/edits",
            {
                **without(FILL, "where"),
                "mode": "connected",
                "at": {"camera": camera, "x": 1, "y": 1},
            },
            {},
            422,
            "at",
        ),
        (
            "a place and a condition",
            "POST",
            L + "/edits",
            {**FILL, "at": {"point": [0, 0, 0]}},
            {},
            422,
            "at",
        ),
        (
            "a polygon of two points",
            "POST",
            L + "/edits",
            {"op": "polygon", "value": 1, "camera": camera, "path": [[1, 1], [9, 9]]},
            {},
            422,
            "path",
        ),
        (
            "a polygon through a singular matrix",
            "POST",
            L + "/edits",
            {"op": "polygon", "value": 1, "camera": singular, "path": [[1, 1], [9, 9], [1, 9]]},
            {},
            422,
            "camera.view",
        ),
        ("two radii", "POST", L + "/edits", {**stroke, "radius_mm": 3}, {}, 422, None),
        ("no radius", "POST", L + "/edits", without(stroke, "radius_px"), {}, 422, None),
        ("radius of zero", "POST", L + "/edits", {**stroke, "radius_px": 0}, {}, 422, "radius_px"),
        ("empty path", "POST", L + "/edits", {**stroke, "path": []}, {}, 422, "path"),
        (
            "a point of three",
            "POST",
            L + "/edits",
            {**stroke, "path": [[1, 2, 3]]},
            {},
            422,
            "path[0]",
        ),
        (
            "a path too long",
            "POST",
            L + "/edits",
            {**stroke, "path": [[1, 2]] * 4097},
            {},
            422,
            "path",
        ),
        (
            "a matrix of fifteen",
            "POST",
            L + "/edits",
            {**stroke, "camera": {**camera, "view": camera["view"][:15]}},
            {},
            422,
            "camera.view",
        ),
        (
            "a singular matrix",
            "POST",
            L + "/edits",
            {**stroke, "camera": singular},
            {},
            422,
            "camera.view",
        ),
        (
            "a window of no width",
            "POST",
            L + "/edits",
            {**stroke, "camera": {**camera, "width": 0}},
            {},
            422,
            "camera.width",
        ),
        (
            "an obtuse angle",
            "POST",
            L + "/edits",
            {**stroke, "max_angle_deg": 91},
            {},
            422,
            "max_angle_deg",
        ),
        (
            "an angle of what is hidden",
            "POST",
            L + "/edits",
            {**stroke, "max_angle_deg": 60, "through": True},
            {},
            422,
            "max_angle_deg",
        ),
        (
            "a negative bias",
            "POST",
            L + "/edits",
            {**stroke, "depth_bias": -0.1},
            {},
            422,
            "depth_bias",
        ),
        ("unknown shape", "POST", L + "/edits", {**stroke, "shape": "star"}, {}, 422, "shape"),
        ("pick without y", "POST", M + "/pick", without(pick, "y"), {}, 422, "y"),
        (
            "pick through a singular matrix",
            "POST",
            M + "/pick",
            {**pick, "camera": singular},
            {},
            422,
            "camera.view",
        ),
        (
            "frame of another format",
            "POST",
            M + "/frame",
            {"camera": camera, "format": "gif"},
            {},
            422,
            "format",
        ),
        (
            "frame too large",
            "POST",
            M + "/frame",
            {"camera": {**camera, "width": 100000}},
            {},
            422,
            "camera.width",
        ),
        (
            "frame of an unknown layer",
            "POST",
            M + "/frame",
            {"camera": camera, "layers": ["nothing"]},
            {},
            404,
            None,
        ),
        (
            "frame of the future",
            "POST",
            M + "/frame",
            {"camera": camera, "at": 10**9},
            {},
            422,
            "at",
        ),
        (
            "position that is no text of a point",
            "GET",
            M + "/position?coords=POINT(1)",
            None,
            {},
            (400, 422),
            "coords",
        ),
        ("position without a place", "GET", M + "/position", None, {}, (400, 422), "coords"),
        ("no positions", "POST", M + "/positions", {"points": []}, {}, 422, "points"),
        (
            "readings without a radius",
            "POST",
            L + "/readings",
            b"x,y,z,value\n0,0,0,1\n",
            {"Content-Type": "text/csv"},
            422,
            "radius_mm",
        ),
        (
            "readings of a negative radius",
            "POST",
            L + "/readings?radius_mm=-1",
            b"x,y,z,value\n0,0,0,1\n",
            {"Content-Type": "text/csv"},
            422,
            "radius_mm",
        ),
        (
            "readings without names",
            "POST",
            L + "/readings?radius_mm=1",
            b"0,0,0,1\n",
            {"Content-Type": "text/csv"},
            422,
            "body",
        ),
        (
            "a reading that the layer cannot hold",
            "POST",
            L + "/readings?radius_mm=1",
            b"x,y,z,value\n0,0,0,0.5\n",
            {"Content-Type": "text/csv"},
            422,
            "body",
        ),
        (
            "a reading far away",
            "POST",
            L + "/readings?radius_mm=1",
            b"x,y,z,value\n1e6,0,0,1\n",
            {"Content-Type": "text/csv"},
            422,
            "body",
        ),
        (
            "no readings at all",
            "POST",
            L + "/readings?radius_mm=1",
            b"",
            {"Content-Type": "text/csv"},
            400,
            "body",
        ),
        (
            "a map along no axis",
            "POST",
            L + "/polygons?value=1&along=up",
            b"{}",
            {"Content-Type": "application/geo+json"},
            422,
            "along",
        ),
        (
            "a map of no value",
            "POST",
            L + "/polygons",
            b"{}",
            {"Content-Type": "application/geo+json"},
            422,
            "value",
        ),
        (
            "a map of two values",
            "POST",
            L + "/polygons?value=1&attribute=a",
            b"{}",
            {"Content-Type": "application/geo+json"},
            422,
            "value",
        ),
        (
            "a map that is none",
            "POST",
            L + "/polygons?value=1",
            b"{}",
            {"Content-Type": "application/geo+json"},
            422,
            "body",
        ),
        (
            "a map that is no JSON",
            "POST",
            L + "/polygons?value=1",
            b"{",
            {"Content-Type": "application/geo+json"},
            400,
            "body",
        ),
        (
            "an orthophoto without a place",
            "POST",
            L + "/picture",
            b"\x89PNG\r\n\x1a\n",
            {"Content-Type": "image/png"},
            422,
            "world",
        ),
        (
            "an orthophoto that is none",
            "POST",
            L + "/picture?world=1,0,0,-1,0,0",
            b"\x89PNG\r\n\x1a\n nonsense",
            {"Content-Type": "image/png"},
            422,
            None,
        ),
        (
            "restore of the future",
            "POST",
            L + "/restore",
            {"sequence": 10**9},
            {},
            422,
            "sequence",
        ),
        ("texels of the future", "GET", L + "/texels.npy?at=1000000000", None, {}, 422, "at"),
        (
            "a raster that is none",
            "PUT",
            L + "/texels.npy",
            b"\x93NUMPY nonsense",
            {"Content-Type": "application/x-npy"},
            422,
            None,
        ),
        (
            "a picture that is none",
            "PUT",
            L + "/texels.png",
            b"\x89PNG\r\n\x1a\n nonsense",
            {"Content-Type": "image/png"},
            422,
            None,
        ),
        ("layer without a name", "POST", M + "/layers", {}, {}, 422, "name"),
        ("layer with an empty name", "POST", M + "/layers", {"name": ""}, {}, 422, "name"),
        (
            "layer of an unknown type",
            "POST",
            M + "/layers",
            {"name": "x", "type": "f64"},
            {},
            422,
            "type",
        ),
        (
            "layer of an odd resolution",
            "POST",
            M + "/layers",
            {"name": "x", "resolution": 3000},
            {},
            422,
            "resolution",
        ),
        (
            "layer too coarse for the atlas",
            "POST",
            M + "/layers",
            {"name": "x", "resolution": 256},
            {},
            422,
            "resolution",
        ),
        (
            "layer with a path as slug",
            "POST",
            M + "/layers",
            {"name": "x", "slug": "../x"},
            {},
            422,
            "slug",
        ),
        (
            "colour that is none",
            "POST",
            M + "/layers",
            {"name": "x", "palette": {"mode": "step", "points": [{"at": 0, "color": "red"}]}},
            {},
            422,
            "palette.points[0].color",
        ),
        ("nothing to undo", "POST", M + "/layers/other/undo", None, {}, 409, None),
        ("nothing to redo", "POST", M + "/layers/other/redo", None, {}, 409, None),
        ("project in use", "DELETE", "/projects/default", None, {}, 409, None),
        ("empty change", "PATCH", M, {}, {}, 422, None),
        ("unknown unit", "PATCH", M, {"unit": "ell"}, {}, 422, "unit"),
        ("opacity above one", "PATCH", L, {"opacity": 1.5}, {}, 422, "opacity"),
        (
            "a change of what somebody changed",
            "PATCH",
            M,
            {"unit": "mm"},
            {"If-Match": '"v999"'},
            412,
            None,
        ),
        (
            "a layer that somebody changed",
            "PATCH",
            L,
            {"opacity": 0.5},
            {"If-Match": '"v999"'},
            412,
            None,
        ),
        ("deletion of what somebody changed", "DELETE", L, None, {"If-Match": '"v999"'}, 412, None),
        (
            "an edit too large",
            "POST",
            L + "/edits",
            b" " * (1 << 20) + b"{}",
            json_type,
            413,
            "body",
        ),
        (
            "a key too long",
            "POST",
            L + "/edits",
            FILL,
            {"Idempotency-Key": "k" * 256},
            400,
            "Idempotency-Key",
        ),
        (
            "a scan of another format",
            "POST",
            "/models?filename=scan.fbx",
            b"Kaydara",
            {},
            415,
            "filename",
        ),
        ("a scan without a file name", "POST", "/models", b"ply\n", {}, 422, "filename"),
        (
            "a scan in an unknown unit",
            "POST",
            "/models?filename=a.ply&unit=inch",
            b"ply\n",
            {},
            422,
            "unit",
        ),
        (
            "a scan for an unknown project",
            "POST",
            "/models?filename=a.ply&project=nothing",
            b"ply\n",
            {},
            404,
            "project",
        ),
        ("a scan on its side", "POST", "/models?filename=a.ply&up=w", b"ply\n", {}, 422, "up"),
        (
            "a coordinate system that is none",
            "POST",
            "/models?filename=a.ply&crs=here",
            b"ply\n",
            {},
            422,
            "crs",
        ),
        (
            "a coordinate system of too many digits",
            "POST",
            "/models?filename=a.ply&crs=EPSG:12345678",
            b"ply\n",
            {},
            422,
            "crs",
        ),
        (
            "a scan for layers too coarse",
            "POST",
            "/models?filename=a.ply&resolution=1024",
            b"ply\n",
            {},
            422,
            "resolution",
        ),
    ]


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    model = server.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
    assert model["slug"] == "grid"
    for name in ("Marks", "Other"):
        server.ok("POST", M + "/layers", {"name": name, "type": "u8"})
    return camera_from(model, [0, 0, 1], up=(0, 1, 0))


def test_each_bad_request_is_refused(server, camera):
    failures = []
    for what, method, path, body, headers, status, field in table(camera):
        answer = server.request(method, path, body, headers)
        statuses = status if isinstance(status, tuple) else (status,)
        try:
            problem = answer.json() if answer.body else {}
        except ValueError:
            problem = {}
        right = (
            answer.status in statuses
            and answer.headers.get("Content-Type") == "application/problem+json"
            and problem.get("status") == answer.status
            and problem.get("title")
            and problem.get("detail")
            and (field is None or problem.get("field") == field)
        )
        if not right:
            failures.append(f"{what}: {method} {path} wanted {status} {field or ''}, got {answer}")
    assert not failures, f"{len(failures)} cases:\n" + "\n".join(failures)
    assert server.get(L).json()["sequence"] == 0, "a refused edit painted"


def test_sign_in(server):
    for token in (False, "x" * 48, "x" * 5000):
        for method, path in (
            ("GET", "/models"),
            ("POST", L + "/edits"),
            ("GET", "/me"),
            ("GET", L + "/texels.npy"),
            ("GET", "/jobs"),
        ):
            answer = server.request(method, path, FILL if method == "POST" else None, token=token)
            assert answer.status in (401, 431) and (
                answer.status == 401 or len(str(token)) > 4000
            ), (method, path, answer)
    for path in ("//livez", "//readyz", "//api/v1/openapi.json", "//problems", "//"):
        assert server.get(path, token=False).status == 200, path
    version = server.get("/version", token=False)
    told = subprocess.run(
        [os.environ["STRATA_BINARY"], "--version"], capture_output=True, text=True, check=True
    )
    assert told.stdout == f"strata {version.json()['version']}\n", (told.stdout, version)
    missing = server.get("/models/nowhere").json()
    page = server.get("//problems", token=False).body.decode()
    assert missing["type"] == "/problems#not_found" and 'id="not_found"' in page, missing
    # The cookie is valid only for requests from this server's own page.
    login = server.post(
        "/login", {"token": server.token}, token=False, headers={"Origin": server.url}
    )
    assert (
        login.status == 200
        and "HttpOnly" in login.headers["Set-Cookie"]
        and "SameSite" in login.headers["Set-Cookie"]
    ), login.headers
    assert "; Secure" not in login.headers["Set-Cookie"], login.headers
    proxied = server.post(
        "/login", {"token": server.token}, token=False, headers={"X-Forwarded-Proto": "https"}
    )
    assert "; Secure" in proxied.headers["Set-Cookie"], proxied.headers
    cookie = {"Cookie": login.headers["Set-Cookie"].split(";")[0]}
    assert server.get("/me", token=False, headers=cookie).json()["role"] == "owner"
    for origin in (
        {},
        {"Origin": "https://elsewhere.example"},
        {"Origin": "null"},
        {"Origin": server.url + ".elsewhere.example"},
    ):
        answer = server.post(L + "/undo", None, token=False, headers={**cookie, **origin})
        assert answer.status == 403, (origin, answer)
    assert (
        server.post(L + "/undo", None, token=False, headers={**cookie, "Origin": server.url}).status
        == 409
    )
    assert (
        server.post("/logout", None, token=False, headers={**cookie, "Origin": server.url}).status
        == 204
    )
    assert server.get("/me", token=False, headers=cookie).status == 401
    assert server.post("/login", {"token": "wrong"}, token=False).status == 401


def test_paths(server):
    """No address gives access to files outside the page's folder, in any encoding."""
    secret = os.path.join(server.data, "secret.txt")
    with open(secret, "w", encoding="ascii") as file:
        file.write("the secret of this test")
    dots = ["..", "%2e%2e", ".%2e", "%2E%2E", "..%00", "%252e%252e", "..\\", "..%5c"]
    targets = [
        "/" + "/".join([dot] * 12) + path for dot in dots for path in (secret, "/etc/passwd")
    ]
    targets += ["/assets/" + target.lstrip("/") for target in targets] + [
        "/assets/" + secret,
        "//" + secret,
        "/%2f" + secret,
    ]
    targets += [
        f"/api/v1/models/grid/source/..%2f..%2f..%2f..{secret.replace('/', '%2f')}",
        "/api/v1/models/grid/source/..%2fgrid.ply",
    ]
    for target in targets:
        answer = raw_request(
            server,
            f"GET {target} HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {server.token}\r\nConnection: close\r\n\r\n".encode(),
        )
        assert b"the secret of" not in answer and b"root:" not in answer, (target, answer[:300])
        status = int(answer.split(b" ")[1])
        assert status in (400, 404) or (status == 200 and b"<strata-app" in answer), (
            target,
            answer[:300],
        )
    for broken in (
        b"nonsense\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        b"GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
        b"POST /api/v1/login HTTP/1.1\r\nContent-Length: 10\r\n\r\n{",
        b"GET / HTTP/1.1\r\n" + b"X: " + b"y" * 20000 + b"\r\n\r\n",
    ):
        answer = raw_request(server, broken)
        assert not answer or answer.split(b" ")[1][:1] == b"4", (broken[:40], answer[:200])
    assert server.get("//livez").status == 200


def test_sizes(server):
    """A raster may be as large as its layer. The server refuses a larger one before the client
    sends it."""
    for size, is_refused in (
        (2 * 2048 * 2048 + 128, False),
        (10 << 20, False),
        (40 << 20, True),
        (3 << 30, True),
    ):
        answer = raw_request(
            server,
            f"PUT /api/v1{L}/texels.npy HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {server.token}\r\n"
            f"Expect: 100-continue\r\nContent-Length: {size}\r\n\r\n".encode(),
        )
        assert answer.startswith(b"HTTP/1.1 413" if is_refused else b"HTTP/1.1 100"), (
            size,
            answer[:300],
        )
    answer = raw_request(
        server,
        f"POST /api/v1/tools?name=x HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {server.token}\r\n"
        f"Expect: 100-continue\r\nContent-Length: {9 << 20}\r\n\r\n".encode(),
    )
    assert answer.startswith(b"HTTP/1.1 413"), answer[:300]


def test_repeats(server, camera):
    """An edit with a key is applied once. The key is valid for one address."""
    stroke = {"op": "stroke", "value": 9, "camera": camera, "radius_px": 30, "path": [[320, 240]]}
    key = {"Idempotency-Key": str(uuid.uuid4())}
    first = server.ok("POST", L + "/edits", stroke, headers=key).json()
    assert first["texels_changed"] > 0
    for _ in range(3):
        assert server.ok("POST", L + "/edits", stroke, headers=key).json() == first
    other = server.ok("POST", M + "/layers/other/edits", stroke, headers=key).json()
    assert other["sequence"] == first["sequence"] + 1, (first, other)
    assert server.get(L + "/edits").json()["total"] == 1
    by_id = f"/models/{server.get(M).json()['id']}/layers/{server.get(L).json()['id']}/edits"
    assert (
        server.ok("POST", by_id, stroke, headers=key).json() == first
    ), "the same layer by another address"
    for another in ({**stroke, "path": [[300, 200]]}, FILL):
        refused = server.post(L + "/edits", another, headers=key)
        assert refused.status == 422 and refused.json()["field"] == "Idempotency-Key", refused
    assert server.get(L).json()["sequence"] == first["sequence"], "a refused edit painted"
    statistics = server.ok("GET", L + "/statistics").json()
    assert (
        sum(bin["texels"] for bin in statistics["histogram"])
        == statistics["texels"]
        == first["texels_changed"]
    ), statistics
    # without a key this is a new edit, which changes nothing
    again = server.ok("POST", L + "/edits", stroke).json()
    assert again["sequence"] == other["sequence"] + 1 and again["texels_changed"] == 0, again
    # the same rule applies to requests that are not edits
    key = {"Idempotency-Key": "layer once"}
    made = server.ok("POST", M + "/layers", {"name": "Once"}, headers=key)
    assert (
        server.ok("POST", M + "/layers", {"name": "Once"}, headers=key).json()["id"]
        == made.json()["id"]
    )
    names = [layer["name"] for layer in server.get(M + "/layers").json()["layers"]]
    assert names.count("Once") == 1, names
    refused = server.post(M + "/layers", {"name": "Twice"}, headers=key)
    assert refused.status == 422 and refused.json()["field"] == "Idempotency-Key", refused
    for method, body in (("PATCH", {"description": "first"}), ("DELETE", None)):
        repeated = [
            server.ok(method, M + "/layers/once", body, headers={"Idempotency-Key": method})
            for _ in range(2)
        ]
        assert (
            repeated[0].body == repeated[1].body and "Idempotency-Replayed" in repeated[1].headers
        ), repeated


def test_import_repeats(server):
    """An import with a key runs once, even if the repeat comes after a restart of the server."""
    scan = folded_grid()

    def ask(content=scan):
        return server.post(
            "/models?filename=once.ply&name=Import+once",
            content,
            headers={"Idempotency-Key": "import once"},
        )

    first = ask()
    assert first.status == 202, first
    job = server.wait_for_job(first.json()["id"])
    assert job["state"] == "done", job
    again = ask()
    assert again.status == 202 and again.headers["Location"] == first.headers["Location"], (
        first,
        again,
    )
    assert ask(scan + b"\n").status == 422
    server.ok("POST", "/models?filename=other.ply&name=Other", scan)
    newest = [known["id"] for known in server.get("/jobs").json()["jobs"]]
    assert newest == sorted(newest, reverse=True) and first.json()["id"] in newest, newest
    wait_for(lambda: server.get("/models/other").status == 200, "the other import")
    server.kill()
    server.start()
    assert (
        server.ok("GET", f"/jobs/{first.json()['id']}").json()["model"] == job["model"]
    ), "jobs are known over restarts"
    later = ask()
    assert later.status == 202, later
    job_later = server.wait_for_job(later.json()["id"])
    assert job_later["state"] == "done" and job_later["model"] == job["model"], (job, job_later)
    assert later.json()["id"] != first.json()["id"]
    assert ask().headers["Location"] == later.headers["Location"]
    assert ask(scan + b"\n").status == 422
    assert [model["name"] for model in server.get("/models").json()["models"]].count(
        "Import once"
    ) == 1
    for model in ("import-once", "other"):
        server.ok("DELETE", f"/models/{model}")


def test_versions(server):
    model = server.get(M)
    tag = {"If-Match": model.headers["ETag"]}
    changed = server.ok("PATCH", M, {"unit": "cm", "scale_verified": True}, headers=tag)
    assert changed.json()["unit"] == "cm" and changed.headers["ETag"] != model.headers["ETag"]
    assert server.request("PATCH", M, {"unit": "m"}, headers=tag).status == 412
    assert server.get(M).json()["unit"] == "cm"
    server.ok("PATCH", M, {"unit": "mm"}, headers={"If-Match": changed.headers["ETag"]})
    # concurrent changes without a version in the request are not reported
    with concurrent.futures.ThreadPoolExecutor(8) as people:
        answers = list(
            people.map(
                lambda i: server.request("PATCH", L, {"description": f"change {i}"}), range(64)
            )
        )
    assert {answer.status for answer in answers} == {200}, [
        answer for answer in answers if answer.status != 200
    ]


def things(server):
    return (
        [model["slug"] for model in server.get("/models").json()["models"]],
        sorted(os.listdir(os.path.join(server.data, "uploads"))),
    )


def test_bad_files(server):
    """An unusable file leaves no data behind."""
    before = things(server)
    good = folded_grid()
    head, _, body = good.partition(b"end_header\n")
    files = [
        ("empty.ply", b""),
        ("text.ply", b"hello"),
        ("head.ply", head),
        ("short.ply", good[: len(good) // 2]),
        (
            "lies.ply",
            head.replace(b"element vertex 441", b"element vertex 2000000000")
            + b"end_header\n"
            + body,
        ),
        ("lists.ply", good[:-13] + b"\xff" + good[-12:]),
        ("empty.obj", b""),
        ("text.obj", b"f 1 2 3\n"),
        ("nan.obj", b"v nan nan nan\nv 0 0 inf\nv 1 0 0\nf 1 2 3\n"),
        ("point.obj", b"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"),
        ("binary.obj", bytes(range(256)) * 100),
    ]
    for name, content in files:
        started = server.post(f"/models?filename={name}", content)
        if started.status == 202:
            job = server.wait_for_job(started.json()["id"])
            assert job["state"] == "failed" and job["problem"]["detail"] and "model" not in job, (
                name,
                job,
            )
        else:
            assert started.status in (400, 422), (name, started)
    assert things(server) == before, (before, things(server))


def test_cancel(server):
    """Imports are canceled while they wait and while they run. No data remains."""
    before = things(server)
    large = bumpy_ball(300, 600)
    first, second = [
        server.ok("POST", f"/models?filename={name}.ply", large).json()["id"]
        for name in ("first", "second")
    ]
    for job in (second, first):  # the second job waits for the first
        server.ok("DELETE", f"/jobs/{job}")
    for job in (second, first):
        state = server.wait_for_job(job)
        assert state["state"] == "cancelled" and "model" not in state, state
        assert server.request("DELETE", f"/jobs/{job}").status == 409
    wait_for(lambda: things(server) == before, f"the uploads to go: {before} {things(server)}")


def test_the_server_is_ready_and_ends_with_a_clean_log(server):
    assert json.loads(server.get("//readyz").body)["ready"] is True
    assert server.stop() == 0
    server.assert_clean_log()
