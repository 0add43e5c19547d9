"""Other people's codes with the numbers people use and with ours."""
