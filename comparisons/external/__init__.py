"""External codes as models: CalculiX, Kratos, plug-ins and any executable."""
