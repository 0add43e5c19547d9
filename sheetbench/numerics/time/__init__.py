"""Integration in time: the interface of integrators to a run, and the control of the step's length."""
