"""Questions asked many times, with truth beside them: convergence, error against run time, stability where it is hard."""
