"""Checks the files of examples/monitoring: the dashboard and the rules are complete, and promtool
accepts the rules and the configuration. metrics_test.cpp checks the names of the metrics.

Exits with 77 after the other checks if promtool (Debian's package `prometheus`) is missing."""
import json
import pathlib
import shutil
import subprocess
import sys

import yaml

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "examples" / "monitoring"


def check_dashboard():
    dashboard = json.loads((FOLDER / "grafana-dashboard.json").read_text(encoding="utf-8"))
    variables = {entry["name"] for entry in dashboard["templating"]["list"]}
    assert variables == {"datasource", "instance"}, variables
    panels = dashboard["panels"]
    assert len({panel["id"] for panel in panels}) == len(panels) > 10
    places = {(panel["gridPos"]["x"], panel["gridPos"]["y"]) for panel in panels}
    assert len(places) == len(panels), "panels overlap"
    for panel in panels:
        assert panel["title"] and panel["description"] and panel["targets"], panel
        for target in panel["targets"]:
            expression = target["expr"]
            assert "strata_" in expression and "$instance" in expression, expression
            assert expression.count("(") == expression.count(")"), expression
            assert expression.count("{") == expression.count("}"), expression


def check_rules():
    groups = yaml.safe_load((FOLDER / "alerts.yaml").read_text(encoding="utf-8"))["groups"]
    rules = [rule for group in groups for rule in group["rules"]]
    assert len({rule["alert"] for rule in rules}) == len(rules) >= 8
    for rule in rules:
        assert rule["labels"]["severity"] in ("page", "ticket"), rule
        assert rule["annotations"]["summary"] and rule["annotations"]["action"], rule
        assert rule["expr"], rule
    scrape = yaml.safe_load((FOLDER / "prometheus.yaml").read_text(encoding="utf-8"))
    jobs = {job["job_name"] for job in scrape["scrape_configs"]}
    assert jobs == {"strata"}, jobs  # the alert StrataDown names this job
    for name in scrape["rule_files"]:
        assert (FOLDER / name).is_file(), name


def main():
    check_dashboard()
    check_rules()
    promtool = shutil.which("promtool")
    if not promtool:
        print(
            "SKIPPED: promtool is not installed, so nothing checked the expressions of the alerts.\n"
            "Install it with: apt-get install prometheus"
        )
        return 77
    for words in (["check", "rules", "alerts.yaml"], ["check", "config", "prometheus.yaml"]):
        done = subprocess.run(
            [promtool, *words], cwd=FOLDER, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{words}: {done.stdout}\n{done.stderr}"
    return 0


if __name__ == "__main__":
    sys.exit(main())
