# A loop that never ends, as the module is loaded
# points: 0, in haste
while True:
    pass
