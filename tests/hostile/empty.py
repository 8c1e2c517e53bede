# Nothing but this comment
# points: 0, by its values alone

