# Threads without end, each in a loop
# points: 0, in haste
import threading


def loop():
    while True:
        pass


while True:
    threading.Thread(target=loop).start()
