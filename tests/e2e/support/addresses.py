"""Makes addresses with their parameters."""
import urllib.parse


def query(path, **parameters):
    return path + "?" + urllib.parse.urlencode(parameters)
