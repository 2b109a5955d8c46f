"""Runs three nodes behind nginx, with the project's example of a configuration, for tests in
JavaScript (js/nodes.mjs), which sends commands."""
import os
import signal
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from support.command_lines import answer_commands, say  # noqa: E402
from support.nginx import Nginx, free_port, site_of_nodes  # noqa: E402
from support.nodes import FAULT_WORDS, Site  # noqa: E402
from support.strata_server import LONG_S, wait_for  # noqa: E402

NAMES = "abc"


class Commands:
    def __init__(self, site, url):
        self.site, self.url = site, url

    def number_of(self, model):
        """Returns the id of a model from its slug."""
        return int(self.site.postgres.sql(f"SELECT id FROM models WHERE slug = '{model}'"))

    def owner_of(self, model):
        return wait_for(lambda: self.site.owner(self.number_of(model)), "a node with the model")

    def owner(self, model):
        return {"url": self.owner_of(model).node_url}

    def kill_owner(self, model):
        node = self.owner_of(model)
        node.kill()
        return {"url": node.node_url}

    def stop_owner(self, model):
        """Sends SIGTERM, and returns when the node has ended."""
        node = self.owner_of(model)
        node.process.send_signal(signal.SIGTERM)
        return {"url": node.node_url, "status": node.process.wait(LONG_S)}

    def start(self):
        """Starts the nodes that do not run."""
        for node in self.site.nodes:
            if not node.runs:
                node.start()
        return {}

    def log(self):
        return {"log": "\n".join(node.end_of_log() for node in self.site.nodes)}

    def stop(self):
        """Stops all nodes. Returns their exit statuses."""
        statuses = [node.stop() for node in self.site.running()]
        for node in self.site.nodes:
            node.assert_clean_log(FAULT_WORDS)
        return {"statuses": statuses}


def main():
    port = free_port()
    url = f"http://127.0.0.1:{port}"
    with tempfile.TemporaryDirectory(prefix="strata-nginx-", dir="/tmp") as folder:
        os.chmod(folder, 0o755)
        urls = [f"{url}/node/{name}" for name in NAMES]
        with Site(len(NAMES), urls=urls, demo="--demo" in sys.argv) as site:
            ports = [node.own_port for node in site.nodes]
            with Nginx(folder, site_of_nodes(port, ports), port):
                say({"url": url, "token": site.token})
                answer_commands(Commands(site, url))


if __name__ == "__main__":
    main()
