"""External codes as models: CalculiX, FElupe, Kratos, MuJoCo and any executable. Nothing else needs them."""
