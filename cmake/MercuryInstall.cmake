# To be filled by the install rules of mercury::sim and mercury::robots.
