# Writes one line without end to every open number
# points: 0, in haste
import os

while True:
    for number in range(3, 64):
        try:
            os.write(number, b"[" * 10**5)
        except OSError:
            pass
