"""Layers whose colors programs compare with pictures."""
from support.readings import dab


def make_colored_layers(server, model):
    """Creates the layer `wet` of numbers with a ramp, and above it the half opaque layer `units` of
    two classes, and paints both."""
    ramp = {
        "mode": "linear",
        "min": 0,
        "max": 10,
        "points": [{"at": 0, "color": "#000000"}, {"at": 10, "color": "#ffcc00"}],
    }
    classes = {
        "mode": "categorical",
        "points": [
            {"at": 1, "color": "#ff0000", "label": "Crack"},
            {"at": 2, "color": "#0000ff80", "label": "Blister"},
        ],
    }
    for layer in (
        {"name": "Wet", "type": "f32", "palette": ramp},
        {"name": "Units", "type": "u8", "palette": classes, "opacity": 0.5},
    ):
        server.ok("POST", f"{model}/layers", {"resolution": 2048, **layer})
    dab(server, f"{model}/layers/wet", 7.5, 40, 40, 30)
    dab(server, f"{model}/layers/units", 1, 60, 40, 25)
    dab(server, f"{model}/layers/units", 2, 40, 70, 25)
