"""The mesh of predictive control by peers, known to both processes: needs none of the peers."""

STEP = 0.01  # of a node, as in Crocoddyl's quadrupedal_gaits [s]
NODES = 40
