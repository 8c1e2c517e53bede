# Writes to every open number, the protocol's pipe among them, without end
# points: 0, in haste
import os

while True:
    for number in range(3, 64):
        try:
            os.write(number, b'{"ready": true}\n' * 1000)
        except OSError:
            pass
