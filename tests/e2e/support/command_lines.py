"""Commands of a test in JavaScript (js/nodes.mjs) to a program in Python: one per line of the input."""
import json
import sys


def say(answer):
    print(json.dumps(answer), flush=True)


def answer_commands(commands):
    """Calls the method of `commands` that a line names, with the other words of this line. Answers
    each line with a line of JSON. Returns at the end of the input."""
    for line in sys.stdin:
        name, *arguments = line.split()
        try:
            say(getattr(commands, name)(*arguments))
        except Exception as error:  # pylint: disable=broad-except
            say({"error": f"{name}: {error!r}"})
