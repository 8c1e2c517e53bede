# Nothing but this comment
# points: 0

