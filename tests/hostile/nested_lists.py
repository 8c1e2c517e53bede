# Lists 10^5 deep, lists in themselves, generators and functions
# points: 0, by its values alone
def deep():
    found = []
    for _ in range(10**5):
        found = [found]
    return found


def hessian(phi, lam):
    return deep()


def branch_points():
    found = []
    found.append(found)
    found.append({"a": found})
    return found


def modes():
    return ([x, x] for x in range(2))


def index(lam):
    return index
