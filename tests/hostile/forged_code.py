# Replies with the source of a function, a lying shape, a dictionary of lists, an error of objects
# points: 0
import os

LINES = [
    b'{"id": [1, 0], "value": {"code": "__import__(\'os\').abort()"}}\n',
    b'{"id": [1, 0], "value": {"array": [], "shape": [1000000000000, 0]}}\n',
    b'{"id": [1, 0], "value": {"array": [1, 2, 3], "shape": [-1, 7]}}\n',
    b'{"id": [1, 0], "value": {"array": "abc", "shape": {}}}\n',
    b'{"id": [1, 0], "value": {"complex": ["1", []]}}\n',
    b'{"id": [1, 0], "value": {"dict": [[[1], 2], 3]}}\n',
    b'{"id": [1, 0], "error": {"a": [[[]]]}, "message": ' + b"[" * 800 + b"]" * 800 + b', "line": {}, "text": [1]}\n',
    b'{"id": [1, 0], "value": ' + b"[" * 800 + b"]" * 800 + b"}\n",
]


def forge(which):
    def function(*_):
        for number in range(3, 64):
            try:
                os.write(number, LINES[which % len(LINES)])
            except OSError:
                pass
        os._exit(0)

    return function


import time

hessian, branch_points, modes, index = (forge(int(time.time() * 1000) + i) for i in range(4))
