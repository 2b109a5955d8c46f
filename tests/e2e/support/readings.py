"""Measured values that are painted on a layer."""
import urllib.parse


def dab(server, layer, value, x, y, radius):
    """Paints a disc of `radius` mm around a point of a flat sheet, as a reading. `layer` is the path
    of the layer in the API."""
    query = urllib.parse.urlencode({"radius_mm": radius})
    return server.ok(
        "POST",
        f"{layer}/readings?{query}",
        f"x,y,z,value\n{x},{y},0,{value}\n",
        headers={"Content-Type": "text/csv"},
    ).json()
