# A loop that never ends, as the module is loaded
# points: 0
while True:
    pass
