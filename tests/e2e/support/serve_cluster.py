"""Runs the example of a cluster (examples/cluster) with one model, for programs in JavaScript
(js/nodes.mjs), which send commands."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from support.cluster_site import ClusterSite  # noqa: E402
from support.command_lines import answer_commands, say  # noqa: E402
from support.meshes import bumpy_ball  # noqa: E402
from support.strata_server import wait_for  # noqa: E402

MODEL = "ball"


class Commands:
    def __init__(self, site, model):
        self.site, self.model = site, model

    def owner(self):
        """Returns the node that owns the model."""
        return wait_for(lambda: self.site.owner(self.model), "a node with the model")

    def primary(self):
        return wait_for(self.site.cluster.primary, "a primary")

    def kill(self, part):
        self.site.cluster.kill(part)
        return part

    def up(self):
        """Starts the parts that do not run, and returns when the cluster is whole."""
        self.site.run("examples/cluster/up")
        return {}


def main():
    with ClusterSite() as site:
        site.run("examples/cluster/up")
        model = site.gate.import_model(bumpy_ball(90, 180), MODEL + ".ply", unit="mm", name="Ball")
        layer = {"name": "Marks", "type": "u8", "resolution": 2048}
        site.gate.ok("POST", f"/models/{MODEL}/layers", layer)
        # otherwise the page asks curators to confirm the scale
        site.gate.ok("PATCH", f"/models/{MODEL}", {"scale_verified": True})
        password = site.cluster.settings["passwords"]["owner"]
        owner = {"user": "owner", "password": password}
        say({"url": site.cluster.url, "token": site.token, "owner": owner})
        answer_commands(Commands(site, model["id"]))


if __name__ == "__main__":
    main()
