"""Light in clouds: the sun's beam, what is scattered in layers, and what an observer sees of it."""
